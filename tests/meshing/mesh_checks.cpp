#include "mesh_checks.h"

#include "meshing/plane_frame.h"
#include "meshing/prepare.h"

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace lambert {

namespace {

std::vector<glm::dvec3> cornersOf(const PatchMesh& mesh, std::size_t patch) {
    std::vector<glm::dvec3> corners;
    for (int k = 0; k < mesh.cornerCount(patch); ++k) corners.emplace_back(mesh.position(patch, k));
    return corners;
}

std::vector<glm::dvec3> cornersOf(const Scene& scene, const Polygon& polygon) {
    std::vector<glm::dvec3> corners;
    for (int k = 0; k < polygon.size(); ++k) corners.emplace_back(corner(scene, polygon, k));
    return corners;
}

glm::dvec3 exactAreaVector(const std::vector<glm::dvec3>& p) {
    return 0.5 * (p.size() == 4 ? glm::cross(p[2] - p[0], p[3] - p[1]) : glm::cross(p[1] - p[0], p[2] - p[0]));
}

std::vector<double> edgeLengths(const std::vector<glm::dvec3>& p) {
    std::vector<double> lengths;
    for (std::size_t k = 0; k < p.size(); ++k) lengths.push_back(glm::distance(p[k], p[(k + 1) % p.size()]));
    return lengths;
}

/// How far a point lies outside of a convex polygon in space, or off its plane.
double outside(const std::vector<glm::dvec3>& p, const glm::dvec3& point) {
    const glm::dvec3 normal = glm::normalize(exactAreaVector(p));
    double distance = std::abs(glm::dot(normal, point - p[0]));
    for (std::size_t k = 0; k < p.size(); ++k) {
        const glm::dvec3 edge = p[(k + 1) % p.size()] - p[k];
        const double length = glm::length(edge);
        if (length > 0.0) distance = std::max(distance, glm::dot(glm::cross(edge, normal), point - p[k]) / length);
    }
    return distance;
}

void expectSoundPatch(const Scene& scene, const PatchMesh& mesh, std::size_t patch, double rounding) {
    const Polygon& polygon = scene.polygons[mesh.polygon[patch]];
    EXPECT_EQ(mesh.material[patch], polygon.material);

    const std::vector<glm::dvec3> corners = cornersOf(mesh, patch);
    const double area = glm::length(exactAreaVector(corners));
    EXPECT_GT(mesh.area[patch], 0.0F);
    EXPECT_NEAR(static_cast<double>(mesh.area[patch]), area, 1e-6 * area); // one rounding to float
    EXPECT_LE(outside(corners, glm::dvec3(mesh.centroid[patch])), rounding);

    // A corner that is rounded turns a flat patch more than a round one.
    const std::vector<double> lengths = edgeLengths(corners);
    const double angle = 1e-5 + 4.0 * rounding * *std::max_element(lengths.begin(), lengths.end()) / area;
    const glm::dvec3 polygonNormal = glm::normalize(exactAreaVector(cornersOf(scene, polygon)));
    const double side = mesh.isBack(patch) ? -1.0 : 1.0;
    EXPECT_NEAR(static_cast<double>(glm::length(mesh.normal[patch])), 1.0, 1e-6); // three roundings to float
    EXPECT_LE(glm::distance(glm::dvec3(mesh.normal[patch]), side * polygonNormal), angle);
    EXPECT_LE(glm::distance(glm::normalize(exactAreaVector(corners)), side * polygonNormal), angle);

    // A vertex on the border was accepted if it is closer to it than two welding tolerances.
    const double tolerance = 2.0 * static_cast<double>(weldTolerance(scene)) + 2.0 * rounding;
    for (const glm::dvec3& p : corners) EXPECT_LE(outside(cornersOf(scene, polygon), p), tolerance);
}

} // namespace

double exactArea(const Scene& scene, const Polygon& polygon) {
    return glm::length(exactAreaVector(cornersOf(scene, polygon)));
}

double exactArea(const PatchMesh& mesh, std::size_t patch) {
    return glm::length(exactAreaVector(cornersOf(mesh, patch)));
}

double coordinateRounding(const Scene& scene) {
    const Bounds bounds = boundsOf(scene);
    const glm::vec3 largest = glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper));
    return 1.2e-7 * static_cast<double>(std::max({largest.x, largest.y, largest.z}));
}

double distanceOutside(const PatchMesh& mesh, std::size_t patch, const glm::vec3& point) {
    return outside(cornersOf(mesh, patch), glm::dvec3(point));
}

double longestEdge(const PatchMesh& mesh, std::size_t patch) {
    const std::vector<double> lengths = edgeLengths(cornersOf(mesh, patch));
    return *std::max_element(lengths.begin(), lengths.end());
}

double shortestEdge(const PatchMesh& mesh, std::size_t patch) {
    const std::vector<double> lengths = edgeLengths(cornersOf(mesh, patch));
    return *std::min_element(lengths.begin(), lengths.end());
}

void expectSoundMesh(const Scene& scene, const PatchMesh& mesh) {
    const std::size_t count = mesh.size();
    ASSERT_LE(mesh.frontCount, count);
    for (const std::size_t size :
         {mesh.centroid.size(), mesh.normal.size(), mesh.area.size(), mesh.polygon.size(), mesh.material.size()})
        ASSERT_EQ(size, count);
    EXPECT_TRUE(
        std::is_sorted(mesh.polygon.begin(), mesh.polygon.begin() + static_cast<std::ptrdiff_t>(mesh.frontCount)));
    EXPECT_TRUE(
        std::is_sorted(mesh.polygon.begin() + static_cast<std::ptrdiff_t>(mesh.frontCount), mesh.polygon.end()));

    const double rounding = coordinateRounding(scene);
    std::vector<double> covered(scene.polygons.size(), 0.0);
    std::size_t back = mesh.frontCount;
    for (std::size_t patch = 0; patch < mesh.frontCount; ++patch) {
        SCOPED_TRACE(testing::Message() << "patch " << patch << " of polygon " << mesh.polygon[patch]);
        expectSoundPatch(scene, mesh, patch, rounding);
        covered[mesh.polygon[patch]] += static_cast<double>(mesh.area[patch]);
        const std::uint32_t expectedBack =
            scene.polygons[mesh.polygon[patch]].backMaterial != kNone ? static_cast<std::uint32_t>(back++) : kNone;
        ASSERT_EQ(mesh.lookup.backPatch(mesh.polygon[patch], static_cast<std::uint32_t>(patch)), expectedBack);
        if (expectedBack == kNone) continue;
        ASSERT_LT(expectedBack, count);
        expectSoundPatch(scene, mesh, expectedBack, rounding);
        EXPECT_EQ(mesh.polygon[expectedBack], mesh.polygon[patch]);
        EXPECT_EQ(mesh.area[expectedBack], mesh.area[patch]);
        EXPECT_EQ(mesh.normal[expectedBack], -mesh.normal[patch]);
        auto reversed = mesh.corners[patch];
        std::reverse(reversed.begin(), reversed.begin() + mesh.cornerCount(patch));
        EXPECT_EQ(mesh.corners[expectedBack], reversed);
    }
    EXPECT_EQ(back, count);
    for (std::size_t i = 0; i < scene.polygons.size(); ++i) {
        const std::vector<glm::dvec3> corners = cornersOf(scene, scene.polygons[i]);
        double perimeter = 0.0;
        for (const double length : edgeLengths(corners)) perimeter += length;
        const double area = glm::length(exactAreaVector(corners));
        // The border is made of rounded vertices.
        EXPECT_NEAR(covered[i], area, 1e-5 * area + rounding * perimeter) << "polygon " << i;
    }
}

void expectNoTVertex(const Scene& scene, const PatchMesh& mesh) {
    const double tolerance = static_cast<double>(weldTolerance(scene));
    using Polygons = std::vector<std::uint32_t>;
    std::map<std::uint32_t, Polygons> used;
    std::map<std::pair<std::uint32_t, std::uint32_t>, Polygons> edges;
    for (std::size_t patch = 0; patch < mesh.frontCount; ++patch)
        for (int k = 0; k < mesh.cornerCount(patch); ++k) {
            const std::uint32_t a = mesh.corners[patch][static_cast<std::size_t>(k)];
            const std::uint32_t b = mesh.corners[patch][static_cast<std::size_t>((k + 1) % mesh.cornerCount(patch))];
            used[a].push_back(mesh.polygon[patch]);
            edges[std::minmax(a, b)].push_back(mesh.polygon[patch]);
        }
    for (const auto& [edgeEnds, edgePolygons] : edges) {
        const auto [a, b] = edgeEnds;
        // Two faces may lie on each other, a shelf's back on a wall: their inner edges know nothing of each
        // other.
        const bool inner = edgePolygons.size() == 2 && edgePolygons[0] == edgePolygons[1];
        const glm::dvec3 from(mesh.positions[a]);
        const glm::dvec3 edge = glm::dvec3(mesh.positions[b]) - from;
        const double squaredLength = glm::dot(edge, edge);
        ASSERT_GT(squaredLength, 0.0);
        for (const auto& [vertex, polygons] : used) {
            if (vertex == a || vertex == b) continue;
            const glm::dvec3 offset = glm::dvec3(mesh.positions[vertex]) - from;
            const double t = glm::dot(offset, edge) / squaredLength;
            if (t <= 0.0 || t >= 1.0 || glm::length(offset - t * edge) > tolerance) continue;
            if (inner && std::find(polygons.begin(), polygons.end(), edgePolygons[0]) == polygons.end()) continue;
            ADD_FAILURE() << "vertex " << vertex << " lies on the edge from " << a << " to " << b << ", at " << t;
            return;
        }
    }
}

void expectClosed(const PatchMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
    for (std::size_t patch = 0; patch < mesh.frontCount; ++patch)
        for (int k = 0; k < mesh.cornerCount(patch); ++k)
            ++runs[{mesh.corners[patch][static_cast<std::size_t>(k)],
                    mesh.corners[patch][static_cast<std::size_t>((k + 1) % mesh.cornerCount(patch))]}];
    for (const auto& [edge, count] : runs) {
        ASSERT_EQ(count, 1) << "patches that run from " << edge.first << " to " << edge.second;
        ASSERT_TRUE(runs.contains({edge.second, edge.first})) << "open edge " << edge.first << "–" << edge.second;
    }
}

} // namespace lambert
