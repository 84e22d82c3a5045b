#pragma once

#include "core/progress.h"
#include "meshing/divide_polygon.h"
#include "meshing/mesh_report.h"
#include "meshing/patch_mesh.h"
#include "scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// Collects the patches of one polygon after the other, in the order of the scene's polygons.
class PatchMeshBuilder {
public:
    /// For about `expected` patches. `scene` and `report` must outlive it.
    PatchMeshBuilder(const Scene& scene, std::size_t expected, MeshReport& report);

    /// At first those of the scene; what is appended is there for the polygons that follow.
    std::vector<glm::vec3>& positions() { return mesh_.positions; }

    /// The next polygon, divided when there were `known` vertices.
    void add(DividedPolygon divided, std::size_t known);

    /// Of the polygons so far, second sides included.
    std::size_t patchCount() const { return mesh_.size() + backs_; }

    /// The mesh of all polygons, with the patches of second sides after all others. Throws Cancelled.
    PatchMesh finish(Progress& progress);

private:
    /// The patches of a polygon.
    struct Division {
        std::uint32_t first;         ///< patch
        std::uint32_t columns, rows; ///< of their grid; 0: no grid
    };

    void addOccluder(std::span<const std::uint32_t> border);
    void append(std::span<const Corners> faces);
    void push(const Corners& corners, const glm::vec3& centroid, const glm::vec3& normal, float area,
              std::uint32_t polygon, std::uint32_t material);
    void addBack(std::uint32_t patch);
    std::size_t patchesWithoutGrid(std::size_t polygon) const;
    void addLookup(Progress& progress);

    const Scene& scene_;
    MeshReport& report_;
    std::vector<Division> divisions_; ///< of the polygons so far
    std::size_t backs_ = 0;           ///< patches of second sides
    PatchMesh mesh_;
};

} // namespace lambert
