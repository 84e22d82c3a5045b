#include "formfactors/local_lines.h"

#include "core/error.h"
#include "core/orthonormal_basis.h"
#include "core/random.h"
#include "core/vector_clones.h"
#include "core/vector_warps.h"
#include "formfactors/hit_sum.h"
#include "formfactors/patch_sampling.h"
#include "meshing/patch_offset.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace lambert {

namespace {

constexpr std::uint32_t kMostLines = 1U << 24;

/// Coordinates of the lines of a patch, #lines each.
struct LineArrays {
    float *originX, *originY, *originZ, *directionX, *directionY, *directionZ;

    LineArrays(std::vector<float>& memory, std::size_t count) {
        memory.resize(6 * count);
        float* next = memory.data();
        for (float** array : {&originX, &originY, &originZ, &directionX, &directionY, &directionZ}) {
            *array = next;
            next += count;
        }
    }

    Ray at(std::size_t i) const {
        return {{originX[i], originY[i], originZ[i]}, {directionX[i], directionY[i], directionZ[i]}};
    }
};

/// Cosine-distributed directions about the frame's z from the first two coordinates of `points` (dimension by dimension).
LAMBERT_VECTOR_CLONES
void makeDirections(const float* points, std::uint32_t count, const OrthonormalBasis& frame, const LineArrays& lines) {
    const LineArrays l = lines;
    const OrthonormalBasis f = frame;
#pragma GCC ivdep
    for (std::uint32_t i = 0; i < count; ++i) {
        const DiskPoint p(points[i], points[i + count]);
        const float squared = 1.0F - p.squaredRadius;
        const float z = std::sqrt(squared > 0.0F ? squared : 0.0F);
        l.directionX[i] = p.x * f.x.x + p.y * f.y.x + z * f.z.x;
        l.directionY[i] = p.x * f.x.y + p.y * f.y.y + z * f.z.y;
        l.directionZ[i] = p.x * f.x.z + p.y * f.y.z + z * f.z.z;
    }
}

/// Of the lines of one patch or point; `kind` tells these apart.
std::uint64_t seedOf(std::uint32_t index, std::uint32_t kind, std::uint64_t seed) {
    return randomKey({index, 0, 0, kind}, seed);
}

} // namespace

LocalLines::LocalLines(const PatchMesh& mesh, const RayCaster& rays, const LocalLinesOptions& options)
    : mesh_(mesh), rays_(rays), options_(options) {
    if (options.lines < 1 || options.lines > kMostLines)
        throw UsageError(fmt::format("lines: found {}, allowed are 1 to {}", options.lines, kMostLines));
    // About four lines per cell: a packet spans four cells.
    cellBits_ = std::min((static_cast<int>(std::bit_width(options.lines / 4)) + 1) / 2, 8);
}

void LocalLines::makeDirections(std::uint64_t seed, const glm::vec3& normal, Lines& lines) const {
    const std::uint32_t count = options_.lines;
    const SamplePoints points(options_.sampler, count, 4, seed);
    lines.points.resize(std::size_t{4} * count);
    for (std::uint32_t d = 0; d < 4; ++d)
        points.fill(0, d, std::span(lines.points).subspan(std::size_t{d} * count, count));
    lambert::makeDirections(lines.points.data(), count, OrthonormalBasis(normal), LineArrays(lines.coordinates, count));
    lines.all.resize(count);
    std::iota(lines.all.begin(), lines.all.end(), 0U);
    lines.order = lines.sorter.order(lines.points, count, 2, cellBits_, lines.all);
}

void LocalLines::makeLines(std::uint32_t patch, Lines& lines) const {
    const std::uint32_t count = options_.lines;
    makeDirections(seedOf(patch, 0x4C494E45, options_.seed), mesh_.normal[patch], lines);
    const LineArrays arrays(lines.coordinates, count);
    const glm::vec3 offset = patchOriginOffset(rays_, mesh_, patch) * mesh_.normal[patch];
    PatchPoints(mesh_, patch)
        .fill(lines.points.data() + std::size_t{2} * count, count, count, offset, arrays.originX, arrays.originY,
              arrays.originZ);
}

void LocalLines::makeLines(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index, Lines& lines) const {
    makeDirections(seedOf(index, 0x504F494E, options_.seed), normal, lines);
    const LineArrays l(lines.coordinates, options_.lines);
    std::fill_n(l.originX, options_.lines, origin.x);
    std::fill_n(l.originY, options_.lines, origin.y);
    std::fill_n(l.originZ, options_.lines, origin.z);
}

std::vector<Ray> LocalLines::lines(std::uint32_t patch) const {
    Lines lines;
    makeLines(patch, lines);
    return inOrder(lines);
}

std::vector<Ray> LocalLines::lines(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index) const {
    Lines lines;
    makeLines(origin, normal, index, lines);
    return inOrder(lines);
}

std::vector<Ray> LocalLines::inOrder(Lines& lines) const {
    const LineArrays l(lines.coordinates, options_.lines);
    std::vector<Ray> result;
    for (const std::uint32_t i : lines.order) result.push_back(l.at(i));
    return result;
}

void LocalLines::row(std::uint32_t patch, RowAccumulator& accumulator) const {
    thread_local Lines lines; // keeps its memory from row to row
    makeLines(patch, lines);
    trace(lines, accumulator);
}

void LocalLines::pointRow(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index,
                          RowAccumulator& accumulator) const {
    thread_local Lines lines;
    makeLines(origin, normal, index, lines);
    trace(lines, accumulator);
}

void LocalLines::trace(Lines& lines, RowAccumulator& accumulator) const {
    const LineArrays l(lines.coordinates, options_.lines);
    const double weight = 1.0 / static_cast<double>(options_.lines);
    RayPacket packet;
    RayOrigins origins;
    HitSum sum(mesh_.lookup, accumulator);
    for (std::size_t first = 0; first < lines.order.size(); first += RayPacket::kSize) {
        const int count = static_cast<int>(std::min<std::size_t>(RayPacket::kSize, lines.order.size() - first));
        for (int lane = 0; lane < RayPacket::kSize; ++lane) {
            // Lanes past the end repeat the last line, inactive.
            const std::uint32_t i = lines.order[first + static_cast<std::size_t>(std::min(lane, count - 1))];
            const Ray line = l.at(i);
            origins.set(lane, line.origin);
            packet.aim(lane, line.direction, lane < count);
        }
        rays_.closest(origins, packet);
        sum.add(packet, count, weight);
    }
    accumulator.setLines(options_.lines);
}

} // namespace lambert
