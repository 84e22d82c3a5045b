#include "formfactors/local_lines.h"

#include "core/error.h"
#include "core/orthonormal_basis.h"
#include "core/random.h"
#include "core/warps.h"
#include "formfactors/hit_sum.h"
#include "formfactors/patch_sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace lambert {

namespace {

constexpr std::uint32_t kMostLines = 1U << 24;

/// The bits of both numbers in turn: cells in this order are neighbours more often than row by row.
/// G. M. Morton, "A computer oriented geodetic data base", IBM 1966.
std::uint32_t mortonCode(std::uint32_t x, std::uint32_t y) {
    const auto spread = [](std::uint32_t v) {
        v = (v | v << 8) & 0x00FF00FFU;
        v = (v | v << 4) & 0x0F0F0F0FU;
        v = (v | v << 2) & 0x33333333U;
        return (v | v << 1) & 0x55555555U;
    };
    return spread(x) | spread(y) << 1;
}

/// The order that sorts by cell, first come first.
std::vector<std::uint32_t> orderByCell(const std::vector<std::uint32_t>& cell, std::size_t cells) {
    std::vector<std::uint32_t> next(cells + 1, 0);
    for (const std::uint32_t c : cell) ++next[c + 1];
    for (std::size_t c = 0; c < cells; ++c) next[c + 1] += next[c];
    std::vector<std::uint32_t> order(cell.size());
    for (std::uint32_t i = 0; i < cell.size(); ++i) order[next[cell[i]]++] = i;
    return order;
}

} // namespace

LocalLines::LocalLines(const PatchMesh& mesh, const RayCaster& rays, const LocalLinesOptions& options)
    : mesh_(mesh), rays_(rays), options_(options) {
    if (options.lines < 1 || options.lines > kMostLines)
        throw UsageError(fmt::format("lines: found {}, allowed are 1 to {}", options.lines, kMostLines));
    // About four lines per cell: a packet spans four cells.
    cellBits_ = std::min((static_cast<int>(std::bit_width(options.lines / 4)) + 1) / 2, 8);
}

std::vector<Ray> LocalLines::lines(std::uint32_t patch) const {
    const auto key = philox({patch, 0, 0, 0x4C494E45}, options_.seed);
    const SamplePoints points(options_.sampler, options_.lines, 4, (std::uint64_t{key[0]} << 32) | key[1]);
    const auto side = static_cast<double>(1U << cellBits_);
    std::vector<std::uint32_t> cell(options_.lines);
    for (std::uint32_t i = 0; i < options_.lines; ++i)
        cell[i] = mortonCode(static_cast<std::uint32_t>(side * points.at(i, 0)),
                             static_cast<std::uint32_t>(side * points.at(i, 1)));

    const OrthonormalBasis basis(mesh_.normal[patch]);
    const PatchPoints starts(mesh_, patch);
    const glm::vec3 offset = rays_.originOffset(std::sqrt(mesh_.area[patch])) * mesh_.normal[patch];
    std::vector<Ray> result;
    result.reserve(options_.lines);
    for (const std::uint32_t i : orderByCell(cell, std::size_t{1} << (2 * cellBits_))) {
        const glm::vec3 d(cosineHemisphere({points.at(i, 0), points.at(i, 1)}));
        result.push_back(
            {starts.at({points.at(i, 2), points.at(i, 3)}) + offset, d.x * basis.x + d.y * basis.y + d.z * basis.z});
    }
    return result;
}

void LocalLines::row(std::uint32_t patch, RowAccumulator& accumulator) const {
    const std::vector<Ray> rays = lines(patch);
    const double weight = 1.0 / static_cast<double>(rays.size());
    RayPacket packet;
    RayOrigins origins;
    HitSum sum(mesh_.lookup, accumulator);
    for (std::size_t first = 0; first < rays.size(); first += RayPacket::kSize) {
        const int count = static_cast<int>(std::min<std::size_t>(RayPacket::kSize, rays.size() - first));
        for (int lane = 0; lane < RayPacket::kSize; ++lane) {
            // Lanes past the end repeat the last line, inactive.
            const Ray& ray = rays[first + static_cast<std::size_t>(std::min(lane, count - 1))];
            origins.x[lane] = ray.origin.x;
            origins.y[lane] = ray.origin.y;
            origins.z[lane] = ray.origin.z;
            packet.directionX[lane] = ray.direction.x;
            packet.directionY[lane] = ray.direction.y;
            packet.directionZ[lane] = ray.direction.z;
            packet.active[lane] = lane < count ? -1 : 0;
        }
        rays_.closest(origins, packet);
        sum.add(packet, count, weight);
    }
    accumulator.setLines(options_.lines);
}

} // namespace lambert
