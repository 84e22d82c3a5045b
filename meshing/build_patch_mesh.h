#pragma once

#include "core/progress.h"
#include "meshing/mesh_report.h"
#include "meshing/patch_mesh.h"

#include <cstddef>
#include <optional>

namespace lambert {

struct MeshOptions {
    std::optional<double> patchLength;  //!< longest edge of a patch, metres, > 0; none: chosen for `patches`
    std::optional<std::size_t> patches; //!< about so many, more if polygons are many: none longer than twice
                                        //!< equal squares; 0 keeps the input's; none: see defaultPatches
    double refinement = 1.0;            //!< factor on what defaultPatches adds to the polygons; > 0
    bool splitContacts = true; //!< divide a polygon along the edges of others that stand on it or hover over it
};

/// A number of patches for a first look: 5000 more than the scene has polygons, or a quarter more if it has many; these
/// numbers times `refinement`.
std::size_t defaultPatches(const Scene& scene, double refinement = 1.0);

/// Divides a prepared scene (see prepareScene) into patches.
PatchMesh buildPatchMesh(const Scene& scene, const MeshOptions& options, Progress& progress,
                         MeshReport* report = nullptr);

} // namespace lambert
