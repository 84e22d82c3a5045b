#include "formfactors/isotropic_lines.h"

#include "core/error.h"
#include "core/orthonormal_basis.h"
#include "core/random.h"
#include "core/vector_clones.h"
#include "core/warps.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

constexpr std::uint32_t kChordsPerBlock = 1U << 13;
constexpr std::uint32_t kMostPerBundle = 1U << 20;
constexpr std::size_t kSize = LinePacket::kSize;

SamplePoints linePoints(const GlobalLineOptions& options) {
    if (options.lines < 1) throw UsageError("global lines: found 0 lines, allowed are 1 to 2^32 - 1");
    if (options.linesPerBundle < 1 || options.linesPerBundle > kMostPerBundle)
        throw UsageError(
            fmt::format("lines per bundle: found {}, allowed are 1 to {}", options.linesPerBundle, kMostPerBundle));
    if (options.set == LineSet::Chords) return {options.sampler, options.lines, 4, options.seed};
    return {options.sampler, (options.lines - 1) / options.linesPerBundle + 1, 2, options.seed};
}

/// sin and cos of |x| <= π/2 to float precision, in code that vectorises.
inline float sine(float x) {
    const float y = x * x;
    return x * (1.0F +
                y * (-1.0F / 6 + y * (1.0F / 120 + y * (-1.0F / 5040 + y * (1.0F / 362880 - y * (1.0F / 39916800))))));
}
inline float cosine(float x) {
    const float y = x * x;
    return 1.0F +
           y * (-0.5F + y * (1.0F / 24 +
                             y * (-1.0F / 720 + y * (1.0F / 40320 + y * (-1.0F / 3628800 + y * (1.0F / 479001600))))));
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

/// A sphere's point for (u, v) of the unit square: uniformSphere in single precision.
struct SpherePoint {
    float x, y, z;
    SpherePoint(float u, float v) {
        z = 1.0F - 2.0F * u;
        const float squared = 1.0F - z * z;
        const float radius = std::sqrt(squared > 0.0F ? squared : 0.0F);
        const float half = std::numbers::pi_v<float> * (v - 0.5F); // of the angle, less π
        const float s = sine(half);
        const float c = cosine(half);
        x = radius * (s * s - c * c);
        y = radius * (-2.0F * s * c);
    }
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
    constexpr float kQuarter = std::numbers::pi_v<float> / 4.0F;
#pragma GCC ivdep
    for (std::uint32_t i = 0; i < count; ++i) {
        const float u = 2.0F * points[i] - 1.0F;
        const float v = 2.0F * points[i + count] - 1.0F;
        const bool wide = std::abs(u) > std::abs(v);
        const float r = wide ? u : v;
        const float other = wide ? v : u;
        const float angle = kQuarter * other / (r != 0.0F ? r : 1.0F);
        const float along = r * cosine(angle);
        const float across = r * sine(angle);
        const float x = wide ? along : across;
        const float y = wide ? across : along;
        l.originX[i] = start.x + x * axisX.x + y * axisY.x;
        l.originY[i] = start.y + x * axisX.y + y * axisY.y;
        l.originZ[i] = start.z + x * axisX.z + y * axisY.z;
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

/// The bits of k, `apart` apart.
std::vector<std::uint32_t> spreadBits(std::uint32_t bits, std::uint32_t apart) {
    std::vector<std::uint32_t> spread(std::size_t{1} << bits, 0);
    for (std::uint32_t k = 0; k < spread.size(); ++k)
        for (std::uint32_t bit = 0; bit < bits; ++bit) spread[k] |= (k >> bit & 1U) << (bit * apart);
    return spread;
}

} // namespace

IsotropicLines::IsotropicLines(const Bounds& bounds, const GlobalLineOptions& options)
    : centre_(0.5F * (bounds.lower + bounds.upper)),
      halfSize_(0.5F * bounds.size() + 1e-4F * 0.5F * bounds.diagonal()),
      radius_(1.0001F * 0.5F * bounds.diagonal()),
      options_(options),
      points_(linePoints(options)) {}

std::uint32_t IsotropicLines::linesPerBlock() const {
    return options_.set == LineSet::Chords ? kChordsPerBlock : options_.linesPerBundle;
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
    sortByCell(count, result);
    pack(result);
}

/// Sorts the kept lines by the cells of their points in the unit cube, a few to a cell, neighbours after neighbours: the bits
/// of the cell's coordinates in turn (G. M. Morton, "A computer oriented geodetic data base", IBM 1966).
void IsotropicLines::sortByCell(std::uint32_t count, Block& result) {
    const auto dimensions = static_cast<std::uint32_t>(result.points.size() / count);
    const std::uint32_t bits = (static_cast<std::uint32_t>(std::bit_width(count)) - 1) / dimensions;
    const std::vector<std::uint32_t> spread = spreadBits(bits, dimensions);
    const auto side = static_cast<float>(1U << bits);
    result.next.assign((std::size_t{1} << (bits * dimensions)) + 1, 0);
    result.cell.clear();
    for (const std::uint32_t i : result.kept) {
        std::uint32_t cell = 0;
        for (std::uint32_t d = 0; d < dimensions; ++d)
            cell |= spread[static_cast<std::uint32_t>(side * result.points[i + std::size_t{d} * count])] << d;
        result.cell.push_back(cell);
        ++result.next[cell + 1];
    }
    for (std::size_t c = 1; c < result.next.size(); ++c) result.next[c] += result.next[c - 1];
    result.order.resize(result.kept.size());
    for (std::size_t k = 0; k < result.kept.size(); ++k) result.order[result.next[result.cell[k]]++] = result.kept[k];
}

void IsotropicLines::pack(Block& result) {
    const std::size_t count = result.order.size();
    result.packets.resize((count + kSize - 1) / kSize);
    for (std::size_t p = 0; p < result.packets.size(); ++p) {
        LinePacket& packet = result.packets[p];
        float* const rows[6] = {packet.originX,    packet.originY,    packet.originZ,
                                packet.directionX, packet.directionY, packet.directionZ};
        for (std::size_t lane = 0; lane < kSize; ++lane) {
            const std::size_t k = kSize * p + lane;
            packet.active[lane] = k < count ? -1 : 0;
            const std::uint32_t line = result.order[std::min(k, count - 1)]; // past the end the last one again
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
    const auto key = philox({bundle, 0, 0, 0x42554E44}, options_.seed);
    const SamplePoints pattern(options_.sampler, options_.linesPerBundle, 2, (std::uint64_t{key[0]} << 32) | key[1]);
    result.points.resize(std::size_t{2} * count);
    for (std::uint32_t d = 0; d < 2; ++d)
        pattern.fill(0, d, std::span(result.points).subspan(std::size_t{d} * count, count));
    const OrthonormalBasis frame(glm::vec3(uniformSphere({points_.at(bundle, 0), points_.at(bundle, 1)})));
    parallels(result.points.data(), count, centre_, radius_, frame, LineArrays(result.lines));
}

} // namespace lambert
