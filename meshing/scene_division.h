#pragma once

#include "core/progress.h"
#include "meshing/contacts.h"
#include "meshing/divide_polygon.h"
#include "meshing/edge_division.h"
#include "meshing/mesh_report.h"
#include "meshing/near_contacts.h"
#include "meshing/patch_mesh_builder.h"
#include "scene/box_index.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace lambert {

/// A prepared scene to be divided into patches, as finely as it takes.
class SceneDivision {
public:
    /// The scene and the report outlive it.
    SceneDivision(const Scene& scene, bool splitContacts, NearContacts near, Progress& progress, MeshReport& report);

    /// Into patches about `length` metres long, of which there will be about `expected`; an earlier division is dropped.
    void divide(double length, double expected);

    /// Tells the report what of the last division is due to near contacts.
    void countNearContacts() const;

    std::size_t patchCount() const { return builder_->patchCount(); }
    PatchMesh finish() { return builder_->finish(progress_); }

private:
    std::size_t someFrom(std::size_t first) const;
    void divideSome(std::size_t first, std::size_t count, const EdgeDivision& edges);

    const Scene& plain_;
    bool splitContacts_;
    NearContacts near_;
    std::optional<Scene> withVertices_;
    const Scene& scene_;                  ///< with the vertices of near contacts
    BoxIndex index_;                      ///< of its vertices
    std::vector<PlanarContact> contacts_; ///< in the polygons' order
    Progress& progress_;
    MeshReport& report_;
    std::optional<PatchMeshBuilder> builder_;
    std::vector<DividedPolygon> divided_;
};

} // namespace lambert
