#include "formfactors/hemicube.h"

#include "core/error.h"
#include "core/random.h"
#include "core/vector_clones.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

/// Unit vectors that span the plane orthogonal to a unit vector.
/// T. Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017.
std::pair<glm::vec3, glm::vec3> tangents(const glm::vec3& n) {
    const float sign = std::copysign(1.0F, n.z);
    const float a = -1.0F / (sign + n.z);
    const float b = n.x * n.y * a;
    return {{1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

/// Delta form factor of a pixel on a hemicube of side 2, per area of the pixel: Cohen, Greenberg 1985.
double deltaFormFactor(bool top, double u, double v) {
    const double d = u * u + v * v + 1.0;
    return (top ? 1.0 : v) / (std::numbers::pi * d * d);
}

LAMBERT_VECTOR_CLONES
bool allEqual(const std::uint32_t (&values)[RayPacket::kSize]) {
    std::uint32_t difference = 0;
    for (int lane = 0; lane < RayPacket::kSize; ++lane) difference |= values[lane] ^ values[0];
    return difference == 0;
}

/// Whether every ray met a front or nothing.
LAMBERT_VECTOR_CLONES
bool allFront(const RayPacket& packet) {
    std::uint32_t backs = 0;
    for (int lane = 0; lane < RayPacket::kSize; ++lane)
        backs |= packet.polygon[lane] != kNone && !(packet.facing[lane] < 0.0F) ? 1U : 0U;
    return backs == 0;
}

/// Runs of neighbouring rays often meet the same patch: one sum for them.
class RunningSum {
public:
    RunningSum(const PatchLookup& lookup, RowAccumulator& accumulator) : lookup_(lookup), accumulator_(accumulator) {}
    ~RunningSum() { accumulator_.add(target_, sum_); }
    RunningSum(const RunningSum&) = delete;
    RunningSum& operator=(const RunningSum&) = delete;

    /// Adds the weights, whose sum is given, to what their rays have hit.
    void add(const RayPacket& packet, const float (&weight)[RayPacket::kSize], double weightSum) {
        alignas(64) std::uint32_t target[RayPacket::kSize];
        findTargets(packet, target);
        if (allEqual(target)) {
            start(target[0]);
            sum_ += weightSum;
            return;
        }
        for (int lane = 0; lane < RayPacket::kSize; ++lane) {
            start(target[lane]);
            sum_ += static_cast<double>(weight[lane]);
        }
    }

private:
    void start(std::uint32_t target) {
        if (target == target_) return;
        accumulator_.add(target_, sum_);
        target_ = target;
        sum_ = 0.0;
    }

    void findTargets(const RayPacket& packet, std::uint32_t (&target)[RayPacket::kSize]) const {
        for (std::uint32_t& t : target) t = accumulator_.out();
        lookup_.patchesAt(packet.polygon, packet.u, packet.v, target);
        if (allFront(packet)) return;
        for (int lane = 0; lane < RayPacket::kSize; ++lane) {
            if (packet.polygon[lane] == kNone || packet.facing[lane] < 0.0F) continue;
            const std::uint32_t back = lookup_.backPatch(packet.polygon[lane], target[lane]);
            target[lane] = back == kNone ? accumulator_.back() : back;
        }
    }

    const PatchLookup& lookup_;
    RowAccumulator& accumulator_;
    std::uint32_t target_ = accumulator_.out();
    double sum_ = 0.0;
};

} // namespace

std::array<HemicubeFace, 5> hemicubeFaces(const glm::vec3& normal, float angle, int resolution) {
    const auto [t0, b0] = tangents(normal);
    const glm::vec3 t = std::cos(angle) * t0 + std::sin(angle) * b0;
    const glm::vec3 b = glm::cross(normal, t);
    const int half = resolution / 2;
    return {{{normal, t, b, resolution, resolution, true},
             {t, b, normal, resolution, half, false},
             {b, -t, normal, resolution, half, false},
             {-t, -b, normal, resolution, half, false},
             {-b, t, normal, resolution, half, false}}};
}

LAMBERT_VECTOR_CLONES
void tileDirections(const HemicubeFace& face, int column, int row, int resolution, RayPacket& packet) {
    const float step = 2.0F / static_cast<float>(resolution);
    const float u0 = -1.0F + 0.5F * step;
    const float v0 = face.top ? u0 : 0.5F * step;
    const glm::vec3 a = face.axis;
    const glm::vec3 b = face.axisU;
    const glm::vec3 c = face.axisV;
    const int columns = face.columns;
    const int rows = face.rows;
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        const int pixelColumn = column + (lane & 3);
        const int pixelRow = row + (lane >> 2);
        const float u = u0 + static_cast<float>(pixelColumn) * step;
        const float v = v0 + static_cast<float>(pixelRow) * step;
        packet.directionX[lane] = a.x + u * b.x + v * c.x;
        packet.directionY[lane] = a.y + u * b.y + v * c.y;
        packet.directionZ[lane] = a.z + u * b.z + v * c.z;
        packet.active[lane] = pixelColumn < columns && pixelRow < rows ? -1 : 0;
    }
}

Hemicube::Hemicube(const PatchMesh& mesh, const RayCaster& rays, const HemicubeOptions& options)
    : mesh_(mesh), rays_(rays), options_(options) {
    const int r = options.resolution;
    if (r < 16 || r > 4096 || r % 2 != 0)
        throw UsageError(fmt::format("hemicube resolution: found {}, allowed are even numbers from 16 to 4096", r));
    topTiles_ = makeTiles(r, true);
    sideTiles_ = makeTiles(r, false);
    double sum = 0.0;
    for (const Tile& tile : topTiles_) sum += tile.sum;
    for (const Tile& tile : sideTiles_) sum += 4.0 * tile.sum;
    for (std::vector<Tile>* tiles : {&topTiles_, &sideTiles_}) {
        for (Tile& tile : *tiles) {
            tile.sum = 0.0;
            for (float& w : tile.weight) {
                w = static_cast<float>(static_cast<double>(w) / sum);
                tile.sum += static_cast<double>(w);
            }
        }
    }
}

std::vector<Hemicube::Tile> Hemicube::makeTiles(int resolution, bool top) {
    const double step = 2.0 / resolution;
    const int rows = top ? resolution : resolution / 2;
    std::vector<Tile> tiles;
    for (int row = 0; row < rows; row += 4) {
        for (int column = 0; column < resolution; column += 4) {
            Tile tile{};
            for (int lane = 0; lane < RayPacket::kSize; ++lane) {
                const int pixelColumn = column + lane % 4;
                const int pixelRow = row + lane / 4;
                if (pixelColumn >= resolution || pixelRow >= rows) continue;
                const double u = -1.0 + (pixelColumn + 0.5) * step;
                const double v = (top ? -1.0 : 0.0) + (pixelRow + 0.5) * step;
                tile.weight[lane] = static_cast<float>(step * step * deltaFormFactor(top, u, v));
                tile.sum += static_cast<double>(tile.weight[lane]);
            }
            tiles.push_back(tile);
        }
    }
    return tiles;
}

std::uint64_t Hemicube::raysPerRow() const {
    const auto r = static_cast<std::uint64_t>(options_.resolution);
    return 3 * r * r;
}

glm::vec3 Hemicube::origin(std::uint32_t patch) const {
    return mesh_.centroid[patch] + rays_.originOffset(std::sqrt(mesh_.area[patch])) * mesh_.normal[patch];
}

float Hemicube::angle(std::uint32_t patch) const {
    if (!options_.randomRotation) return 0.0F;
    const auto random = philox({patch, 0, 0, 0}, options_.seed);
    return 2.0F * std::numbers::pi_v<float> * uniformFloat(random[0]);
}

void Hemicube::row(std::uint32_t patch, RowAccumulator& accumulator) const {
    pointRow(origin(patch), mesh_.normal[patch], angle(patch), accumulator);
}

void Hemicube::pointRow(const glm::vec3& origin, const glm::vec3& normal, float angle,
                        RowAccumulator& accumulator) const {
    RayPacket packet;
    RunningSum sum(mesh_.lookup, accumulator);
    for (const HemicubeFace& face : hemicubeFaces(normal, angle, options_.resolution)) {
        const Tile* tile = face.top ? topTiles_.data() : sideTiles_.data();
        for (int row = 0; row < face.rows; row += 4) {
            for (int column = 0; column < face.columns; column += 4, ++tile) {
                tileDirections(face, column, row, options_.resolution, packet);
                rays_.closest(origin, packet);
                sum.add(packet, tile->weight, tile->sum);
            }
        }
    }
}

} // namespace lambert
