#include "formfactors/block_cover.h"

#include "core/vector_clones.h"
#include "scene/surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lambert {

namespace {

constexpr double kMargin = 0.25;     ///< pixels
constexpr double kEdgeOn = 1e-9;     ///< sine, or so, below which a polygon is taken to be seen from its plane
constexpr float kFarther = 1.00001F; ///< ratio of depths
constexpr float kNearest = std::numeric_limits<float>::infinity();

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

} // namespace

/// A polygon against blocks: where its edges' planes and its depth lie at block centres, and by how much they vary in a block.
struct BlockCover::BlockTest {
    struct Plane {
        float at, perColumn; ///< at the row's first centre; positive inside
        float reach;         ///< how much it changes to a block's farthest pixel
    };
    std::array<Plane, 4> edges; ///< a triangle repeats its last
    std::array<Plane, 2> depth; ///< of the two halves
    std::uint32_t polygon;
    bool mayCover;
};

void BlockCover::Blocks::reset(std::size_t count) {
    coverDepth.assign(count, 0.0F);
    coverPolygon.assign(count, kNone);
    depth.assign(count, 0.0F);
    nextDepth.assign(count, 0.0F);
    depthPolygon.assign(count, kNone);
}

BlockCover::BlockCover(const Scene& scene, const glm::vec3& origin) : scene_(scene) {
    corners_.reserve(scene.polygons.size());
    for (const Polygon& polygon : scene.polygons) {
        Corners& corners = corners_.emplace_back();
        for (int k = 0; k < 4; ++k)
            corners[static_cast<std::size_t>(k)] =
                glm::dvec3(corner(scene, polygon, std::min(k, polygon.size() - 1))) - glm::dvec3(origin);
    }
    faceCorners_.resize(corners_.size());
}

void BlockCover::face(const HemicubeFace& face, int resolution) {
    columns_ = face.columns;
    rows_ = face.rows;
    blockColumns_ = (columns_ + kSize - 1) / kSize;
    blockRows_ = (rows_ + kSize - 1) / kSize;
    step_ = 2.0 / resolution;
    firstU_ = -1.0 + 0.5 * step_;
    firstV_ = face.top ? firstU_ : 0.5 * step_;
    blocks_.reset(static_cast<std::size_t>(blockColumns_) * static_cast<std::size_t>(blockRows_));
    const glm::dvec3 axis(face.axis);
    const glm::dvec3 axisU(face.axisU);
    const glm::dvec3 axisV(face.axisV);
    for (std::uint32_t i = 0; i < corners_.size(); ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::dvec3& c = corners_[i][k];
            faceCorners_[i][k] = {glm::dot(c, axis), glm::dot(c, axisU), glm::dot(c, axisV)};
        }
        place(i);
    }
    polygon_.resize(blocks_.depth.size());
    for (std::size_t b = 0; b < polygon_.size(); ++b) {
        const std::uint32_t polygon = blocks_.coverPolygon[b];
        const float others = blocks_.depthPolygon[b] == polygon ? blocks_.nextDepth[b] : blocks_.depth[b];
        polygon_[b] = kFarther * others < blocks_.coverDepth[b] ? polygon : kNone;
    }
    // The last blocks may hang over.
    if (columns_ % kSize != 0)
        for (int row = 0; row < blockRows_; ++row)
            polygon_[static_cast<std::size_t>((row + 1) * blockColumns_ - 1)] = kNone;
    if (rows_ % kSize != 0) std::fill(polygon_.end() - blockColumns_, polygon_.end(), kNone);
}

/// Enters a polygon into all blocks that it may touch.
void BlockCover::place(std::uint32_t polygon) {
    const Corners& q = faceCorners_[polygon];
    const std::size_t count = static_cast<std::size_t>(scene_.polygons[polygon].size());
    int firstColumn = 0;
    int lastColumn = blockColumns_ - 1;
    int firstRow = 0;
    int lastRow = blockRows_ - 1;

    const double blockStep = kSize * step_;
    const double lowestU = firstU_ - kMargin * step_;
    const double lowestV = firstV_ - kMargin * step_;
    const double highestU = firstU_ + (columns_ - 1 + kMargin) * step_;
    const double highestV = firstV_ + (rows_ - 1 + kMargin) * step_;
    glm::dvec2 lower(std::numeric_limits<double>::max());
    glm::dvec2 upper(std::numeric_limits<double>::lowest());
    bool before = true; // the plane through the origin, all of it
    std::array<bool, 5> beyond{true, true, true, true, true};
    for (std::size_t k = 0; k < count; ++k) {
        const auto& [w, u, v] = std::array{q[k].x, q[k].y, q[k].z};
        beyond[0] &= w <= 0.0;
        beyond[1] &= u < lowestU * w;
        beyond[2] &= u > highestU * w;
        beyond[3] &= v < lowestV * w;
        beyond[4] &= v > highestV * w;
        before &= w > 1e-6 * largest(q[k]);
        lower = glm::min(lower, glm::dvec2(u, v) / w);
        upper = glm::max(upper, glm::dvec2(u, v) / w);
    }
    for (const bool out : beyond)
        if (out) return;
    if (before) {
        const auto blockOf = [&](double at, double first, int last) {
            return static_cast<int>(std::clamp(std::floor((at - first) / blockStep), 0.0, static_cast<double>(last)));
        };
        // A block's pixels with their margin leave half a pixel to the next.
        firstColumn = blockOf(lower.x, lowestU, lastColumn);
        lastColumn = blockOf(upper.x, lowestU, lastColumn);
        firstRow = blockOf(lower.y, lowestV, lastRow);
        lastRow = blockOf(upper.y, lowestV, lastRow);
    }

    // Seen as a convex polygon, its cone is what lies inside of all planes through the origin and an edge.
    std::array<glm::dvec3, 4> edge;
    double smallest = std::numeric_limits<double>::max();
    double side = 0.0;
    bool clear = true;
    for (std::size_t k = 0; k < count; ++k) {
        edge[k] = glm::cross(q[k], q[(k + 1) % count]);
        const glm::dvec3& other = q[(k + 2) % count];
        const double volume = glm::dot(edge[k], other);
        if (k == 0) side = volume > 0.0 ? 1.0 : -1.0;
        clear &= volume * side > kEdgeOn * largest(q[k]) * largest(q[(k + 1) % count]) * largest(other);
        smallest = std::min(smallest, std::abs(volume));
    }
    if (count == 3) edge[3] = edge[2];

    BlockTest test{.edges = {}, .depth = {}, .polygon = polygon, .mayCover = false};
    const double reach = 0.5 * (kSize - 1) + kMargin;
    const auto plane = [&](const glm::dvec3& normal, double scale, double row) {
        const double u = firstU_ + (firstColumn * kSize + 0.5 * (kSize - 1)) * step_;
        const double v = firstV_ + (row * kSize + 0.5 * (kSize - 1)) * step_;
        return BlockTest::Plane{
            static_cast<float>(scale * (normal.x + u * normal.y + v * normal.z)),
            static_cast<float>(scale * normal.y * blockStep),
            static_cast<float>(std::abs(scale) * reach * step_ * (std::abs(normal.y) + std::abs(normal.z)))};
    };
    const glm::dvec3 normal = glm::cross(q[1] - q[0], q[3] - q[0]);
    const glm::dvec3 otherNormal = count == 4 ? glm::cross(q[3] - q[2], q[1] - q[2]) : normal;
    test.mayCover = clear && !hasHoles(scene_, scene_.polygons[polygon]);
    const auto columns = static_cast<std::size_t>(lastColumn - firstColumn + 1);
    for (int row = firstRow; row <= lastRow; ++row) {
        const auto first = static_cast<std::size_t>(row * blockColumns_ + firstColumn);
        if (!clear) {
            std::fill_n(blocks_.nextDepth.begin() + static_cast<std::ptrdiff_t>(first), columns, kNearest);
            std::fill_n(blocks_.depth.begin() + static_cast<std::ptrdiff_t>(first), columns, kNearest);
            continue;
        }
        for (std::size_t k = 0; k < 4; ++k) test.edges[k] = plane(edge[k], side / largest(edge[k]), row);
        test.depth[0] = plane(normal, 1.0 / glm::dot(normal, q[0]), row);
        test.depth[1] = plane(otherNormal, 1.0 / glm::dot(otherNormal, q[2]), row);
        testRow(test, first, columns, blocks_);
    }
}

LAMBERT_VECTOR_CLONES
void BlockCover::testRow(const BlockTest& test, std::size_t first, std::size_t count, Blocks& blocks) {
    const BlockTest t = test;
    float* coverDepth = blocks.coverDepth.data() + first;
    std::uint32_t* coverPolygon = blocks.coverPolygon.data() + first;
    float* depth = blocks.depth.data() + first;
    float* nextDepth = blocks.nextDepth.data() + first;
    std::uint32_t* depthPolygon = blocks.depthPolygon.data() + first;
    for (std::size_t k = 0; k < count; ++k) {
        const auto column = static_cast<float>(static_cast<int>(k));
        float inside = kNearest;  // of the block's outermost pixel
        float outside = kNearest; // of its innermost
        for (const BlockTest::Plane& edge : t.edges) {
            const float at = edge.at + column * edge.perColumn;
            inside = std::min(inside, at - edge.reach);
            outside = std::min(outside, at + edge.reach);
        }
        const float one = t.depth[0].at + column * t.depth[0].perColumn;
        const float two = t.depth[1].at + column * t.depth[1].perColumn;
        const float least = std::min(one - t.depth[0].reach, two - t.depth[1].reach);
        const float greatest = std::max(one + t.depth[0].reach, two + t.depth[1].reach);
        const bool covers = t.mayCover && inside > 0.0F && least > coverDepth[k];
        coverDepth[k] = covers ? least : coverDepth[k];
        coverPolygon[k] = covers ? t.polygon : coverPolygon[k];
        const float reached = outside >= 0.0F ? greatest : 0.0F;
        const bool nearest = reached > depth[k];
        const float lower = nearest ? depth[k] : reached;
        nextDepth[k] = std::max(nextDepth[k], lower);
        depthPolygon[k] = nearest ? t.polygon : depthPolygon[k];
        depth[k] = nearest ? reached : depth[k];
    }
}

namespace {

/// u and v of 4 × 4 pixels as quotients of linear forms, each {at the tile's first pixel, per column, per row}.
struct ChartForms {
    std::array<float, 3> u, v, divisor;
};

LAMBERT_VECTOR_CLONES
void chart(const ChartForms& forms, float (&u)[RayPacket::kSize], float (&v)[RayPacket::kSize]) {
    const ChartForms f = forms;
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        const auto column = static_cast<float>(lane & 3);
        const auto row = static_cast<float>(lane >> 2);
        const float inverse = 1.0F / (f.divisor[0] + column * f.divisor[1] + row * f.divisor[2]);
        u[lane] = (f.u[0] + column * f.u[1] + row * f.u[2]) * inverse;
        v[lane] = (f.v[0] + column * f.v[1] + row * f.v[2]) * inverse;
    }
}

} // namespace

void BlockCover::hits(std::uint32_t polygon, int column, int row, RayPacket& packet) const {
    const Corners& q = faceCorners_[polygon];
    const double u = firstU_ + column * step_;
    const double v = firstV_ + row * step_;
    const auto chartOf = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double scale = 1.0 / largest(normal);
        const auto form = [&](const glm::dvec3& n) {
            return std::array{static_cast<float>(scale * (n.x + u * n.y + v * n.z)),
                              static_cast<float>(scale * step_ * n.y), static_cast<float>(scale * step_ * n.z)};
        };
        return ChartForms{form(glm::cross(c, a)), form(glm::cross(a, b)), form(normal)};
    };
    chart(chartOf(q[0], q[1], q[3]), packet.u, packet.v);
    if (scene_.polygons[polygon].isQuad()) {
        alignas(64) float farU[RayPacket::kSize], farV[RayPacket::kSize];
        chart(chartOf(q[2], q[3], q[1]), farU, farV);
        for (int lane = 0; lane < RayPacket::kSize; ++lane) {
            const bool far = packet.u[lane] + packet.v[lane] > 1.0F;
            packet.u[lane] = far ? 1.0F - farU[lane] : packet.u[lane];
            packet.v[lane] = far ? 1.0F - farV[lane] : packet.v[lane];
        }
    }
    const Corners& c = corners_[polygon];
    const bool front =
        glm::dot(c[0], glm::cross(c[1] - c[0], c[3] - c[0])) < 0.0 && !isOccluder(scene_, scene_.polygons[polygon]);
    std::fill_n(packet.polygon, RayPacket::kSize, polygon);
    std::fill_n(packet.facing, RayPacket::kSize, front ? -1.0F : 1.0F);
}

} // namespace lambert
