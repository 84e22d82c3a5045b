#include "mesh_checks.h"
#include "sample_scenes.h"

#include "scene/rays/ray_caster.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace lambert {
namespace {

struct ChartPoint {
    float u, v;
};

/// Uniform in the chart, which for triangles is the half below the diagonal.
ChartPoint randomChartPoint(const Polygon& polygon, std::mt19937& random) {
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    ChartPoint p{uniform(random), uniform(random)};
    if (!polygon.isQuad() && p.u + p.v > 1.0F) p = {1.0F - p.u, 1.0F - p.v};
    return p;
}

/// The patches of each polygon: [first, end).
std::vector<std::pair<std::uint32_t, std::uint32_t>> patchRanges(const Scene& scene, const PatchMesh& mesh) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges(scene.polygons.size(), {kNone, 0});
    for (std::uint32_t patch = 0; patch < mesh.frontCount; ++patch) {
        auto& [first, end] = ranges[mesh.polygon[patch]];
        first = std::min(first, patch);
        end = patch + 1;
    }
    return ranges;
}

class PatchLookupOf : public testing::TestWithParam<SampleScene> {
protected:
    /// Whole polygons, some patches, many; contacts and slivers among them.
    std::vector<PatchMesh> meshes() const {
        const auto size = static_cast<double>(boundsOf(GetParam().scene).diagonal());
        std::vector<PatchMesh> result;
        for (const double length : {10.0 * size, 0.3 * size, 0.02 * size})
            result.push_back(meshWithLength(GetParam().scene, length));
        return result;
    }
    const Scene& scene() const { return GetParam().scene; }
};

/// That the patches found at random points of each polygon contain them.
void expectFindsPatches(const Scene& scene, const PatchMesh& mesh, int pointsPerPolygon, std::mt19937& random) {
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        for (int k = 0; k < pointsPerPolygon; ++k) {
            const auto [u, v] = randomChartPoint(scene.polygons[i], random);
            const std::uint32_t patch = mesh.lookup.patchAt(i, u, v);
            ASSERT_LT(patch, mesh.frontCount);
            ASSERT_EQ(mesh.polygon[patch], i);
            // The lookup computes in float, in units of the polygon, of which a patch is a small part.
            ASSERT_LE(distanceOutside(mesh, patch, polygonPoint(scene, i, u, v)),
                      1e-4 * longestEdge(mesh, patch) + 4.0 * coordinateRounding(scene))
                << "polygon " << i << " at " << u << ", " << v;
        }
    }
}

TEST_P(PatchLookupOf, FindsThePatchThatContainsThePoint) {
    SCOPED_TRACE("seed 1");
    std::mt19937 random(1);
    for (const PatchMesh& mesh : meshes())
        expectFindsPatches(scene(), mesh, scene().polygons.size() < 20 ? 4000 : 200, random);
}

// More than are divided, and more without a grid than are located, at a time.
TEST(PatchLookup, FindsThePatchesOfALargeMesh) {
    SCOPED_TRACE("seed 1");
    std::mt19937 random(1);
    const Scene scene = dataScene("table_room.gltf");
    Progress progress;
    MeshOptions options;
    options.patches = 400'000;
    const PatchMesh mesh = buildPatchMesh(scene, options, progress);
    EXPECT_GT(mesh.size(), 360'000U);
    expectSoundMesh(scene, mesh);
    expectFindsPatches(scene, mesh, 100, random);
}

TEST_P(PatchLookupOf, Answers16AtOnceAsOneByOne) {
    SCOPED_TRACE("seed 2");
    std::mt19937 random(2);
    const auto count = static_cast<std::uint32_t>(scene().polygons.size());
    for (const PatchMesh& mesh : meshes()) {
        for (int round = 0; round < 2000; ++round) {
            std::uint32_t polygon[16], patch[16];
            float u[16], v[16];
            // By turns: one polygon, several, several with lanes that hit nothing.
            const std::uint32_t shared = static_cast<std::uint32_t>(random()) % count;
            for (int lane = 0; lane < 16; ++lane) {
                polygon[lane] = round % 3 == 0 ? shared : static_cast<std::uint32_t>(random()) % count;
                const ChartPoint p = randomChartPoint(scene().polygons[polygon[lane]], random);
                if (round % 3 == 2 && random() % 4 == 0) polygon[lane] = kNone;
                u[lane] = p.u;
                v[lane] = p.v;
                patch[lane] = 12345678;
            }
            mesh.lookup.patchesAt(polygon, u, v, patch);
            for (int lane = 0; lane < 16; ++lane) {
                const std::uint32_t expected =
                    polygon[lane] == kNone ? 12345678 : mesh.lookup.patchAt(polygon[lane], u[lane], v[lane]);
                ASSERT_EQ(patch[lane], expected) << "polygon " << polygon[lane] << " at " << u[lane] << ", " << v[lane];
            }
        }
    }
}

TEST_P(PatchLookupOf, AnswersManyAsOneByOne) {
    SCOPED_TRACE("seed 3");
    std::mt19937 random(3);
    const auto count = static_cast<std::uint32_t>(scene().polygons.size());
    for (const PatchMesh& mesh : meshes()) {
        std::vector<std::uint32_t> polygon(1001), patch(polygon.size());
        std::vector<float> u(polygon.size()), v(polygon.size());
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            polygon[k] = static_cast<std::uint32_t>(random()) % count;
            const ChartPoint p = randomChartPoint(scene().polygons[polygon[k]], random);
            u[k] = p.u;
            v[k] = p.v;
        }
        mesh.lookup.patchesAt(polygon, u, v, patch);
        for (std::size_t k = 0; k < polygon.size(); ++k)
            ASSERT_EQ(patch[k], mesh.lookup.patchAt(polygon[k], u[k], v[k]))
                << "polygon " << polygon[k] << " at " << u[k] << ", " << v[k];
    }
}

TEST_P(PatchLookupOf, StaysWithinThePolygonOnItsBorderAndALittleOutside) {
    const float charts[]{-1e-6F, 0.0F, 1e-6F, 0.25F, 0.5F, 1.0F - 1e-6F, 1.0F, 1.0F + 1e-6F};
    for (const PatchMesh& mesh : meshes()) {
        const auto ranges = patchRanges(scene(), mesh);
        for (std::uint32_t i = 0; i < scene().polygons.size(); ++i) {
            const auto [first, end] = ranges[i];
            for (const float u : charts) {
                for (const float v : charts) {
                    if (!scene().polygons[i].isQuad() && u + v > 1.000003F) continue;
                    const std::uint32_t patch = mesh.lookup.patchAt(i, u, v);
                    ASSERT_GE(patch, first) << u << ", " << v;
                    ASSERT_LT(patch, end) << u << ", " << v;
                    const double outside = distanceOutside(mesh, patch, polygonPoint(scene(), i, u, v));
                    const auto size = static_cast<double>(boundsOf(scene()).diagonal());
                    EXPECT_LE(outside, 1e-4 * longestEdge(mesh, patch) + 4e-6 * size) << i << ": " << u << ", " << v;
                    std::uint32_t polygons[16], found[16];
                    float us[16], vs[16];
                    std::fill_n(polygons, 16, i);
                    std::fill_n(us, 16, u);
                    std::fill_n(vs, 16, v);
                    mesh.lookup.patchesAt(polygons, us, vs, found);
                    ASSERT_EQ(found[7], patch) << u << ", " << v;
                }
            }
        }
    }
}

TEST_P(PatchLookupOf, FindsEachPatchAtItsCentroid) {
    // The chart of a centroid is not known, but a ray from just above it finds it.
    const RayCaster caster(scene());
    for (const PatchMesh& mesh : meshes()) {
        std::size_t other = 0;
        for (std::uint32_t patch = 0; patch < mesh.frontCount; ++patch) {
            // Far above what the plane of a sliver is off in the caster's float.
            const float above = std::max(1e-3F * std::sqrt(mesh.area[patch]), 1e-4F * caster.bounds().diagonal());
            const auto hit = caster.closest({mesh.centroid[patch] + above * mesh.normal[patch], -mesh.normal[patch]});
            if (!hit || hit->polygon != mesh.polygon[patch]) {
                ++other; // another face lies on this one
                continue;
            }
            if (exactArea(mesh, patch) < 1e-3 * longestEdge(mesh, patch) * longestEdge(mesh, patch)) continue;
            ASSERT_EQ(mesh.lookup.patchAt(hit->polygon, hit->u, hit->v), patch);
        }
        EXPECT_LE(other, mesh.frontCount / 4);
    }
}

TEST_P(PatchLookupOf, FindsThePatchThatARayHits) {
    SCOPED_TRACE("seed 3");
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    const RayCaster caster(scene());
    const Bounds bounds = caster.bounds();
    const glm::vec3 centre = 0.5F * (bounds.lower + bounds.upper);
    for (const PatchMesh& mesh : meshes()) {
        for (int i = 0; i < 4000; ++i) {
            const glm::vec3 offset(normal(random), normal(random), normal(random));
            const glm::vec3 target(normal(random), normal(random), normal(random));
            const glm::vec3 origin = centre + 0.4F * offset * bounds.diagonal();
            const glm::vec3 direction = centre + 0.1F * target * bounds.diagonal() - origin;
            const auto hit = caster.closest({origin, direction});
            if (!hit) continue;
            const std::uint32_t patch = mesh.lookup.patchAt(hit->polygon, hit->u, hit->v);
            ASSERT_EQ(mesh.polygon[patch], hit->polygon);
            // (u, v) of a ray in float: a few roundings at the ray's length. A grazing ray stretches its
            // distance.
            const glm::vec3 point = polygonPoint(scene(), hit->polygon, hit->u, hit->v);
            const double rounding = 1e-6 * static_cast<double>(bounds.diagonal());
            EXPECT_LE(distanceOutside(mesh, patch, point), 1e-4 * longestEdge(mesh, patch) + rounding);
            const glm::vec3 onRay = origin + hit->distance * direction;
            const double cosine =
                std::abs(static_cast<double>(glm::dot(glm::normalize(direction), mesh.normal[patch])));
            EXPECT_LE(distanceOutside(mesh, patch, onRay),
                      1e-4 * longestEdge(mesh, patch) + 5.0 * rounding / std::max(cosine, 1e-3));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Samples, PatchLookupOf, testing::ValuesIn(sampleScenes()),
                         [](const auto& sample) { return sample.param.name; });

TEST(PatchLookup, FindsThePatchInManyRandomQuads) {
    for (std::uint32_t seed = 100; seed < 400; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        const Scene scene = flatScene(randomConvexQuad(seed));
        std::mt19937 random(seed);
        for (const double length : {0.5, 0.1, 0.03}) {
            const PatchMesh mesh = meshWithLength(scene, length);
            for (int k = 0; k < 200; ++k) {
                const auto [u, v] = randomChartPoint(scene.polygons[0], random);
                const std::uint32_t patch = mesh.lookup.patchAt(0, u, v);
                const double outside = distanceOutside(mesh, patch, polygonPoint(scene, 0, u, v));
                ASSERT_LE(outside, 1e-4 * longestEdge(mesh, patch) + 4.0 * coordinateRounding(scene));
            }
        }
    }
}

TEST(PatchLookup, FindsBackPatchesOnlyOfTwoSidedPolygons) {
    Scene scene = roomWithTurnedBox();
    scene.polygons[2].backMaterial = 0;
    scene.polygons[5].backMaterial = 0;
    const PatchMesh mesh = meshWithLength(scene, 0.3);
    std::uint32_t next = static_cast<std::uint32_t>(mesh.frontCount);
    for (std::uint32_t patch = 0; patch < mesh.frontCount; ++patch) {
        const std::uint32_t polygon = mesh.polygon[patch];
        const bool twoSided = polygon == 2 || polygon == 5;
        EXPECT_EQ(mesh.lookup.backPatch(polygon, patch), twoSided ? next++ : kNone);
    }
    EXPECT_EQ(next, mesh.size());
}

} // namespace
} // namespace lambert
