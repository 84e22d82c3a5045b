#include "meshing/patch_offset.h"

#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/example_scenes.h"
#include "scene/rays/ray_caster.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lambert {
namespace {

PatchMesh divided(const Scene& scene, double length) {
    MeshOptions options;
    options.patchLength = length;
    Progress progress;
    return buildPatchMesh(scene, options, progress);
}

/// A plate in the plane z = 0, and one that stands on its edge, whose corners are `beneath` metres off that plane: near
/// enough to become vertices of the plate.
Scene plates(float beneath, bool twoSided) {
    const std::array<std::array<glm::vec3, 4>, 2> quads{
        {{{{0, 0, 0}, {6, 0, 0}, {6, 6, 0}, {0, 6, 0}}},
         {{{2, 0, -beneath}, {2, 0, -5}, {4, 0, -5}, {4, 0, -beneath}}}}};
    Material material;
    material.reflectance = Rgb(0.5F);
    material.twoSided = twoSided;
    const std::array<Material, 2> materials{material, material};
    return prepareScene(quadScene(quads, materials));
}

double lowestCorner(const PatchMesh& mesh) {
    double lowest = 0.0;
    for (const glm::vec3& p : mesh.positions)
        if (p.z > -1.0F) lowest = std::min(lowest, static_cast<double>(p.z));
    return lowest;
}

TEST(PatchOriginOffset, ClearsThePolygonWhereItsBorderTookUpAVertexOffItsPlane) {
    const float beneath =
        1.5e-5F; // within twice the weld tolerance, 1e-6 of a diagonal of 10 m; more than the offset of 6e-6 m
    const Scene scene = plates(beneath, false);
    const RayCaster rays(scene);
    const PatchMesh mesh = divided(scene, 1.0);
    ASSERT_LT(lowestCorner(mesh), -0.9 * static_cast<double>(beneath)) << "the vertex was not taken up";
    ASSERT_LT(rays.originOffset(0.0F), beneath);
    int lifted = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        if (mesh.polygon[i] != 0) continue;
        const float offset = patchOriginOffset(rays, mesh, i);
        lifted += offset > beneath ? 1 : 0;
        for (int k = 0; k < mesh.cornerCount(i); ++k) {
            // Just inside of the corner, where the patch is as low as it is.
            const glm::vec3 point = 0.99F * mesh.position(i, k) + 0.01F * mesh.centroid[i];
            const auto hit = rays.closest({point + offset * mesh.normal[i], mesh.normal[i]});
            EXPECT_FALSE(hit) << i << ": meets the polygon " << hit->polygon;
        }
    }
    EXPECT_GE(lifted, 2);
}

TEST(PatchOriginOffset, IsNoMoreThanThatOfAPointOnPlanePolygons) {
    for (const Scene& scene : {plates(0.0F, true), prepareScene(roomWithBoxScene())}) {
        const RayCaster rays(scene);
        for (const double length : {100.0, 0.3}) {
            const PatchMesh mesh = divided(scene, length);
            for (std::size_t i = 0; i < mesh.size(); ++i)
                EXPECT_EQ(patchOriginOffset(rays, mesh, i), rays.originOffset(std::sqrt(mesh.area[i])));
        }
    }
}

TEST(PatchOriginOffset, OfSecondSidesCountsFromTheirSide) {
    // What lies beneath the front is above the back.
    const Scene scene = plates(1.5e-5F, true);
    const RayCaster rays(scene);
    const PatchMesh mesh = divided(scene, 1.0);
    ASSERT_GT(mesh.size(), mesh.frontCount);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        if (mesh.polygon[i] != 0) continue;
        const glm::vec3 origin = mesh.centroid[i] + patchOriginOffset(rays, mesh, i) * mesh.normal[i];
        const auto hit = rays.closest({origin, mesh.normal[i]});
        EXPECT_TRUE(!hit || hit->polygon != 0) << i;
    }
}

} // namespace
} // namespace lambert
