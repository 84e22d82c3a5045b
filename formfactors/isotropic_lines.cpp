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

constexpr std::uint32_t kChordsPerBlock = 1U << 14;
constexpr std::uint32_t kMostPerBundle = 1U << 20;
constexpr int kSize = LinePacket::kSize;

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

/// A sphere's point for (u, v) of the unit square: uniformSphere in single precision.
struct SpherePoint {
    float x, y, z;
    SpherePoint(double u, double v) {
        z = 1.0F - 2.0F * static_cast<float>(u);
        const float squared = 1.0F - z * z;
        const float radius = std::sqrt(squared > 0.0F ? squared : 0.0F);
        const float half = std::numbers::pi_v<float> * (static_cast<float>(v) - 0.5F); // of the angle, less π
        const float s = sine(half);
        const float c = cosine(half);
        x = radius * (s * s - c * c);
        y = radius * (-2.0F * s * c);
    }
};

/// Chords between the points (p0, p1) and (p2, p3) of the unit square, mapped to the sphere, of the `count` indices in `order`.
LAMBERT_VECTOR_CLONES
void chords(const double* const (&p)[4], const std::uint32_t* order, const glm::vec3& centre, float sphereRadius,
            LinePacket& packet) {
    const float cx = centre.x;
    const float cy = centre.y;
    const float cz = centre.z;
    for (int lane = 0; lane < kSize; ++lane) {
        const std::uint32_t i = order[lane];
        const SpherePoint a(p[0][i], p[1][i]);
        const SpherePoint b(p[2][i], p[3][i]);
        packet.originX[lane] = cx + sphereRadius * a.x;
        packet.originY[lane] = cy + sphereRadius * a.y;
        packet.originZ[lane] = cz + sphereRadius * a.z;
        packet.directionX[lane] = sphereRadius * (b.x - a.x);
        packet.directionY[lane] = sphereRadius * (b.y - a.y);
        packet.directionZ[lane] = sphereRadius * (b.z - a.z);
    }
}

/// Lines along the frame's z through the points (p0, p1) of the unit square, mapped to the disk as concentricDisk does.
LAMBERT_VECTOR_CLONES
void parallels(const double* const (&p)[2], const std::uint32_t* order, const glm::vec3& centre, float radius,
               const OrthonormalBasis& frame, LinePacket& packet) {
    const glm::vec3 start = centre - radius * frame.z;
    const glm::vec3 axisX = radius * frame.x;
    const glm::vec3 axisY = radius * frame.y;
    const glm::vec3 direction = 2.0F * radius * frame.z;
    constexpr float kQuarter = std::numbers::pi_v<float> / 4.0F;
    for (int lane = 0; lane < kSize; ++lane) {
        const std::uint32_t i = order[lane];
        const float u = 2.0F * static_cast<float>(p[0][i]) - 1.0F;
        const float v = 2.0F * static_cast<float>(p[1][i]) - 1.0F;
        const bool wide = std::abs(u) > std::abs(v);
        const float r = wide ? u : v;
        const float other = wide ? v : u;
        const float angle = kQuarter * (r != 0.0F ? other / r : 0.0F);
        const float along = r * cosine(angle);
        const float across = r * sine(angle);
        const float x = wide ? along : across;
        const float y = wide ? across : along;
        packet.originX[lane] = start.x + x * axisX.x + y * axisY.x;
        packet.originY[lane] = start.y + x * axisX.y + y * axisY.y;
        packet.originZ[lane] = start.z + x * axisX.z + y * axisY.z;
        packet.directionX[lane] = direction.x;
        packet.directionY[lane] = direction.y;
        packet.directionZ[lane] = direction.z;
    }
}

/// Sorts the points of [0, 1)^dimensions by their cells, about four to a cell, neighbours after neighbours: the bits of the
/// cell's coordinates in turn (G. M. Morton, IBM 1966). `order` is padded with its last element to whole packets.
void sortByCell(const std::vector<double>& points, std::uint32_t count, std::uint32_t dimensions,
                std::vector<std::uint32_t>& cell, std::vector<std::uint32_t>& order) {
    const std::uint32_t bits = (static_cast<std::uint32_t>(std::bit_width(count)) - 1) / dimensions;
    const auto side = static_cast<double>(1U << bits);
    cell.assign(count, 0);
    // Spread the bits of a coordinate, `dimensions` apart.
    std::vector<std::uint32_t> spread(std::size_t{1} << bits, 0);
    for (std::uint32_t k = 0; k < spread.size(); ++k)
        for (std::uint32_t bit = 0; bit < bits; ++bit) spread[k] |= (k >> bit & 1U) << (bit * dimensions);
    for (std::uint32_t d = 0; d < dimensions; ++d) {
        const double* coordinate = points.data() + std::size_t{d} * count;
        for (std::uint32_t i = 0; i < count; ++i)
            cell[i] |= spread[static_cast<std::size_t>(side * coordinate[i])] << d;
    }
    std::vector<std::uint32_t> next((std::size_t{1} << (bits * dimensions)) + 1, 0);
    for (const std::uint32_t c : cell) ++next[c + 1];
    for (std::size_t c = 1; c < next.size(); ++c) next[c] += next[c - 1];
    order.resize((count + kSize - 1) / kSize * kSize);
    for (std::uint32_t i = 0; i < count; ++i) order[next[cell[i]]++] = i;
    std::fill(order.begin() + count, order.end(), order[count - 1]);
}

void setActive(std::uint32_t count, std::vector<LinePacket>& packets) {
    packets.resize((count + kSize - 1) / kSize);
    for (LinePacket& packet : packets) std::fill_n(packet.active, kSize, -1);
    for (std::uint32_t lane = (count - 1) % kSize + 1; lane < kSize; ++lane) packets.back().active[lane] = 0;
}

} // namespace

IsotropicLines::IsotropicLines(const Bounds& bounds, const GlobalLineOptions& options)
    : centre_(0.5F * (bounds.lower + bounds.upper)),
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

void IsotropicLines::fill(std::uint64_t block, Block& result) const {
    const auto first = static_cast<std::uint32_t>(linesBefore(block));
    const auto count = static_cast<std::uint32_t>(linesBefore(block + 1) - first);
    setActive(count, result.packets);
    if (options_.set == LineSet::Chords)
        fillChords(first, count, result);
    else
        fillBundle(static_cast<std::uint32_t>(block), count, result);
}

void IsotropicLines::fillChords(std::uint32_t first, std::uint32_t count, Block& result) const {
    result.points.resize(std::size_t{4} * count);
    for (std::uint32_t d = 0; d < 4; ++d)
        points_.fill(first, d, std::span(result.points).subspan(std::size_t{d} * count, count));
    sortByCell(result.points, count, 4, result.cell, result.order);
    const double* p = result.points.data();
    for (std::size_t k = 0; k < result.packets.size(); ++k)
        chords({p, p + count, p + std::size_t{2} * count, p + std::size_t{3} * count}, result.order.data() + kSize * k,
               centre_, radius_, result.packets[k]);
}

void IsotropicLines::fillBundle(std::uint32_t bundle, std::uint32_t count, Block& result) const {
    const auto key = philox({bundle, 0, 0, 0x42554E44}, options_.seed);
    const SamplePoints pattern(options_.sampler, options_.linesPerBundle, 2, (std::uint64_t{key[0]} << 32) | key[1]);
    result.points.resize(std::size_t{2} * count);
    for (std::uint32_t d = 0; d < 2; ++d)
        pattern.fill(0, d, std::span(result.points).subspan(std::size_t{d} * count, count));
    sortByCell(result.points, count, 2, result.cell, result.order);
    const OrthonormalBasis frame(glm::vec3(uniformSphere({points_.at(bundle, 0), points_.at(bundle, 1)})));
    const double* p = result.points.data();
    for (std::size_t k = 0; k < result.packets.size(); ++k)
        parallels({p, p + count}, result.order.data() + kSize * k, centre_, radius_, frame, result.packets[k]);
}

} // namespace lambert
