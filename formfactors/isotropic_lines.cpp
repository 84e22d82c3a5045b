#include "formfactors/isotropic_lines.h"

#include "core/error.h"
#include "core/orthonormal_basis.h"
#include "core/random.h"
#include "core/vector_clones.h"
#include "core/vector_warps.h"
#include "core/warps.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace lambert {

namespace {

constexpr std::uint32_t kMostPerBlock = 1U << 20;
constexpr std::size_t kSize = LinePacket::kSize;

SamplePoints linePoints(const GlobalLineOptions& options) {
    if (options.lines < 1) throw UsageError("global lines: found 0 lines, allowed are 1 to 2^32 - 1");
    if (options.linesPerBundle < 1 || options.linesPerBundle > kMostPerBlock)
        throw UsageError(
            fmt::format("lines per bundle: found {}, allowed are 1 to {}", options.linesPerBundle, kMostPerBlock));
    if (options.chordsPerBlock < 1 || options.chordsPerBlock > kMostPerBlock)
        throw UsageError(
            fmt::format("chords per block: found {}, allowed are 1 to {}", options.chordsPerBlock, kMostPerBlock));
    if (options.set == LineSet::Chords) return {options.sampler, options.lines, 4, options.seed};
    return {options.sampler, (options.lines - 1) / options.linesPerBundle + 1, 2, options.seed};
}

/// Coordinates of lines, as vector code sees them.
struct LineArrays {
    float *originX, *originY, *originZ, *directionX, *directionY, *directionZ;

    explicit LineArrays(std::array<std::vector<float>, 6>& lines)
        : originX(lines[0].data()),
          originY(lines[1].data()),
          originZ(lines[2].data()),
          directionX(lines[3].data()),
          directionY(lines[4].data()),
          directionZ(lines[5].data()) {}
};

/// Chords between the points (p0, p1) and (p2, p3) of the unit square, mapped to the sphere. `points`: 4 × count.
LAMBERT_VECTOR_CLONES
void chords(const float* points, std::uint32_t count, const glm::vec3& centre, float radius, const LineArrays& lines) {
    const LineArrays l = lines;
    const glm::vec3 c = centre;
#pragma GCC ivdep
    for (std::uint32_t i = 0; i < count; ++i) {
        const SpherePoint a(points[i], points[i + count]);
        const SpherePoint b(points[i + 2 * count], points[i + 3 * count]);
        l.originX[i] = c.x + radius * a.x;
        l.originY[i] = c.y + radius * a.y;
        l.originZ[i] = c.z + radius * a.z;
        l.directionX[i] = radius * (b.x - a.x);
        l.directionY[i] = radius * (b.y - a.y);
        l.directionZ[i] = radius * (b.z - a.z);
    }
}

/// Lines along the frame's z through the points (p0, p1) of the unit square, mapped to the disk as concentricDisk does.
LAMBERT_VECTOR_CLONES
void parallels(const float* points, std::uint32_t count, const glm::vec3& centre, float radius,
               const OrthonormalBasis& frame, const LineArrays& lines) {
    const LineArrays l = lines;
    const glm::vec3 start = centre - radius * frame.z;
    const glm::vec3 axisX = radius * frame.x;
    const glm::vec3 axisY = radius * frame.y;
    const glm::vec3 direction = 2.0F * radius * frame.z;
#pragma GCC ivdep
    for (std::uint32_t i = 0; i < count; ++i) {
        const DiskPoint p(points[i], points[i + count]);
        l.originX[i] = start.x + p.x * axisX.x + p.y * axisY.x;
        l.originY[i] = start.y + p.x * axisX.y + p.y * axisY.y;
        l.originZ[i] = start.z + p.x * axisX.z + p.y * axisY.z;
        l.directionX[i] = direction.x;
        l.directionY[i] = direction.y;
        l.directionZ[i] = direction.z;
    }
}

/// Whether the lines come through the box: no axis that is normal to the line and to one of the box parts them.
LAMBERT_VECTOR_CLONES
void findMeeting(const LineArrays& lines, std::uint32_t count, const glm::vec3& centre, const glm::vec3& halfSize,
                 std::uint8_t* meets) {
    const LineArrays l = lines;
    const glm::vec3 c = centre;
    const glm::vec3 h = halfSize;
#pragma GCC ivdep
    for (std::uint32_t i = 0; i < count; ++i) {
        const float px = l.originX[i] - c.x;
        const float py = l.originY[i] - c.y;
        const float pz = l.originZ[i] - c.z;
        const float dx = l.directionX[i];
        const float dy = l.directionY[i];
        const float dz = l.directionZ[i];
        const float ax = std::abs(dx);
        const float ay = std::abs(dy);
        const float az = std::abs(dz);
        const bool x = std::abs(dy * pz - dz * py) <= h.y * az + h.z * ay;
        const bool y = std::abs(dz * px - dx * pz) <= h.z * ax + h.x * az;
        const bool z = std::abs(dx * py - dy * px) <= h.x * ay + h.y * ax;
        meets[i] = static_cast<std::uint8_t>(x & y & z);
    }
}

} // namespace

IsotropicLines::IsotropicLines(const Bounds& bounds, const GlobalLineOptions& options)
    : centre_(0.5F * (bounds.lower + bounds.upper)),
      halfSize_(0.5F * bounds.size() + 1e-4F * 0.5F * bounds.diagonal()),
      radius_(1.0001F * 0.5F * bounds.diagonal()),
      options_(options),
      points_(linePoints(options)) {}

std::uint32_t IsotropicLines::linesPerBlock() const {
    return options_.set == LineSet::Chords ? options_.chordsPerBlock : options_.linesPerBundle;
}

std::uint64_t IsotropicLines::blockCount() const { return (options_.lines - 1) / linesPerBlock() + std::uint64_t{1}; }

std::uint64_t IsotropicLines::linesBefore(std::uint64_t blocks) const {
    return std::min<std::uint64_t>(blocks * linesPerBlock(), options_.lines);
}

void IsotropicLines::fill(std::uint64_t block, Block& result, Keep keep) const {
    const auto first = static_cast<std::uint32_t>(linesBefore(block));
    const auto count = static_cast<std::uint32_t>(linesBefore(block + 1) - first);
    for (std::vector<float>& coordinates : result.lines) coordinates.resize(count);
    if (options_.set == LineSet::Chords)
        makeChords(first, count, result);
    else
        makeBundle(static_cast<std::uint32_t>(block), count, result);

    result.meets.assign(count, 1);
    if (keep == Keep::MeetingBounds)
        findMeeting(LineArrays(result.lines), count, centre_, halfSize_, result.meets.data());
    result.kept.resize(count);
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < count; ++i) { // without a branch that no one can predict
        result.kept[kept] = i;
        kept += result.meets[i];
    }
    result.kept.resize(kept);
    if (keep == Keep::AllAsDrawn) return pack(result, result.kept);
    const auto dimensions = static_cast<std::uint32_t>(result.points.size() / count);
    const int bits = (std::bit_width(count) - 1) / static_cast<int>(dimensions);
    pack(result, result.sorter.order(result.points, count, dimensions, bits, result.kept));
}

void IsotropicLines::pack(Block& result, std::span<const std::uint32_t> order) {
    const std::size_t count = order.size();
    result.packets.resize((count + kSize - 1) / kSize);
    for (std::size_t p = 0; p < result.packets.size(); ++p) {
        LinePacket& packet = result.packets[p];
        float* const rows[6] = {packet.originX,    packet.originY,    packet.originZ,
                                packet.directionX, packet.directionY, packet.directionZ};
        for (std::size_t lane = 0; lane < kSize; ++lane) {
            const std::size_t k = kSize * p + lane;
            packet.active[lane] = k < count ? -1 : 0;
            const std::uint32_t line = order[std::min(k, count - 1)]; // past the end the last one again
            for (std::size_t c = 0; c < 6; ++c) rows[c][lane] = result.lines[c][line];
        }
    }
}

void IsotropicLines::makeChords(std::uint32_t first, std::uint32_t count, Block& result) const {
    result.points.resize(std::size_t{4} * count);
    for (std::uint32_t d = 0; d < 4; ++d)
        points_.fill(first, d, std::span(result.points).subspan(std::size_t{d} * count, count));
    chords(result.points.data(), count, centre_, radius_, LineArrays(result.lines));
}

void IsotropicLines::makeBundle(std::uint32_t bundle, std::uint32_t count, Block& result) const {
    const SamplePoints pattern(options_.sampler, options_.linesPerBundle, 2,
                               randomKey({bundle, 0, 0, 0x42554E44}, options_.seed));
    result.points.resize(std::size_t{2} * count);
    for (std::uint32_t d = 0; d < 2; ++d)
        pattern.fill(0, d, std::span(result.points).subspan(std::size_t{d} * count, count));
    const OrthonormalBasis frame(glm::vec3(uniformSphere({points_.at(bundle, 0), points_.at(bundle, 1)})));
    parallels(result.points.data(), count, centre_, radius_, frame, LineArrays(result.lines));
}

} // namespace lambert
