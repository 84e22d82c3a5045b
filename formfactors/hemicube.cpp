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

double sumOfWeights(int resolution) {
    const auto faces = hemicubeFaces({0.0F, 0.0F, 1.0F}, 0.0F, resolution);
    RayPacket packet;
    alignas(64) float weight[RayPacket::kSize];
    double sum = 0.0;
    for (const HemicubeFace& face : faces) {
        // Double per face row: a float sum of 50 million pixels would lose the small ones.
        for (int row = 0; row < face.rows; row += 4)
            for (int column = 0; column < face.columns; column += 4) {
                hemicubeTile(face, column, row, resolution, packet, weight);
                for (const float w : weight) sum += static_cast<double>(w);
            }
    }
    return sum;
}

/// What one ray of a packet adds to a row: runs of neighbouring rays often meet the same patch.
class RunningSum {
public:
    RunningSum(const PatchLookup& lookup, RowAccumulator& accumulator) : lookup_(lookup), accumulator_(accumulator) {}
    ~RunningSum() { flush(); }
    RunningSum(const RunningSum&) = delete;
    RunningSum& operator=(const RunningSum&) = delete;

    void add(const RayPacket& packet, const float (&weight)[RayPacket::kSize]) {
        for (int lane = 0; lane < RayPacket::kSize; ++lane) {
            const auto w = static_cast<double>(weight[lane]);
            if (w == 0.0) continue;
            const std::uint32_t polygon = packet.polygon[lane];
            if (polygon == kNone) {
                accumulator_.addOut(w);
                continue;
            }
            std::uint32_t patch = lookup_.patchAt(polygon, packet.u[lane], packet.v[lane]);
            if (!(packet.facing[lane] < 0.0F)) patch = lookup_.backPatch(polygon, patch);
            if (patch != patch_) {
                flush();
                patch_ = patch;
            }
            sum_ += w;
        }
    }

private:
    void flush() {
        if (sum_ > 0.0) {
            if (patch_ == kNone)
                accumulator_.addBack(sum_);
            else
                accumulator_.add(patch_, sum_);
        }
        sum_ = 0.0;
    }

    const PatchLookup& lookup_;
    RowAccumulator& accumulator_;
    std::uint32_t patch_ = kNone; ///< kNone: a black back
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
void hemicubeTile(const HemicubeFace& face, int column, int row, int resolution, RayPacket& packet,
                  float (&weight)[RayPacket::kSize]) {
    const float step = 2.0F / static_cast<float>(resolution);
    const float u0 = -1.0F + 0.5F * step;
    const float v0 = face.top ? u0 : 0.5F * step;
    const float constant = face.top ? 1.0F : 0.0F;
    const float slope = 1.0F - constant;
    const glm::vec3 a = face.axis;
    const glm::vec3 b = face.axisU;
    const glm::vec3 c = face.axisV;
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        const int pixelColumn = column + (lane & 3);
        const int pixelRow = row + (lane >> 2);
        const bool inside = pixelColumn < face.columns && pixelRow < face.rows;
        const float u = u0 + static_cast<float>(pixelColumn) * step;
        const float v = v0 + static_cast<float>(pixelRow) * step;
        packet.directionX[lane] = a.x + u * b.x + v * c.x;
        packet.directionY[lane] = a.y + u * b.y + v * c.y;
        packet.directionZ[lane] = a.z + u * b.z + v * c.z;
        packet.active[lane] = inside ? -1 : 0;
        const float d = u * u + v * v + 1.0F;
        weight[lane] = inside ? (constant + slope * v) / (d * d) : 0.0F;
    }
}

Hemicube::Hemicube(const PatchMesh& mesh, const RayCaster& rays, const HemicubeOptions& options)
    : mesh_(mesh), rays_(rays), options_(options) {
    const int r = options.resolution;
    if (r < 16 || r > 4096 || r % 2 != 0)
        throw UsageError(fmt::format("hemicube resolution: found {}, allowed are even numbers from 16 to 4096", r));
    pixelScale_ = static_cast<float>(1.0 / sumOfWeights(r));
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
    alignas(64) float weight[RayPacket::kSize];
    RunningSum sum(mesh_.lookup, accumulator);
    for (const HemicubeFace& face : hemicubeFaces(normal, angle, options_.resolution)) {
        for (int row = 0; row < face.rows; row += 4) {
            for (int column = 0; column < face.columns; column += 4) {
                hemicubeTile(face, column, row, options_.resolution, packet, weight);
                for (float& w : weight) w *= pixelScale_;
                rays_.closest(origin, packet);
                sum.add(packet, weight);
            }
        }
    }
}

} // namespace lambert
