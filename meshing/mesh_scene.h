#pragma once

#include "core/progress.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/patch_optics.h"
#include "meshing/prepare.h"
#include "scene/rays/ray_caster.h"

#include <memory>

namespace lambert {

/// A scene as form factors are computed on it.
struct MeshedScene {
    std::shared_ptr<const Scene> scene; //!< as prepared: welded, joined; polygons as the rays see them
    std::unique_ptr<RayCaster> rays;    //!< of `scene`
    PatchMesh mesh;
    PatchOptics optics; //!< of `mesh`, as the scene has it
    PrepareReport prepareReport;
    MeshReport meshReport;
};

/// Prepares and meshes a scene. Throws InputError if nothing of any size is in it, Cancelled.
MeshedScene meshScene(const Scene& scene, const MeshOptions& options, Progress& progress);

/// The same for what needs light. Throws InputError if the scene has none.
MeshedScene meshLitScene(const Scene& scene, const MeshOptions& options, Progress& progress);

} // namespace lambert
