#include "baking/vertex_smoothing.h"

#include "core/orthonormal_basis.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace lambert {

namespace {

constexpr int kMostRings = 4;
constexpr double kConfidence = 0.7; ///< standard errors; more let fits grow until they are as wrong as they are noisy
constexpr double kChosen = 1.4;     ///< of several estimates the one that is taken looks better than it is

} // namespace

VertexSmoothing::VertexSmoothing(const BakedMesh& mesh) : mesh_(mesh), begin_(mesh.positions.size() + 1, 0) {
    const auto forEachEdge = [&](const auto& action) {
        for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
            const std::size_t count = mesh.isQuad(face) ? 4 : 3;
            for (std::size_t k = 0; k < count; ++k) action(mesh.faces[face][k], mesh.faces[face][(k + 1) % count]);
        }
    };
    forEachEdge([&](std::uint32_t a, std::uint32_t b) {
        ++begin_[a + 1];
        ++begin_[b + 1];
    });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    neighbours_.resize(begin_.back());
    std::vector<std::uint32_t> ends(begin_.begin(), begin_.end() - 1);
    forEachEdge([&](std::uint32_t a, std::uint32_t b) {
        neighbours_[ends[a]++] = b;
        neighbours_[ends[b]++] = a;
    });
}

/// Samples of the vertices in `next_`, which become the ring; theirs that were not seen yet are the next.
void VertexSmoothing::Worker::addRing(std::span<const NoisyValue> values, std::uint32_t vertex) {
    ring_.swap(next_);
    next_.clear();
    const BakedMesh& mesh = smoothing_.mesh_;
    for (const std::uint32_t v : ring_) {
        for (const std::uint32_t other : smoothing_.neighbours(v)) {
            if (std::exchange(seen_[other], round_) != round_) next_.push_back(other);
        }
        const NoisyValue& found = values[v];
        if (found.rays == 0) continue;
        const glm::vec3 way = mesh.positions[v] - mesh.positions[vertex];
        samples_.push_back({static_cast<double>(glm::dot(way, along_)), static_cast<double>(glm::dot(way, across_)),
                            static_cast<double>(found.rays), RgbSum(found.value), RgbSum(found.variance)});
    }
}

/// Weights are rays, not variances: few rays that met nothing bright know of no variance. For the same reason the variance is that of
/// all samples of as many rays.
SmoothedValue VertexSmoothing::Worker::fit() const {
    glm::dmat3 normal(0.0);
    for (const Sample& s : samples_) {
        const glm::dvec3 row(1.0, s.x, s.y);
        normal += s.rays * glm::outerProduct(row, row);
    }
    // Of places on a line, or one place: the mean.
    const double size = normal[1][1] + normal[2][2];
    const bool spread = glm::determinant(normal) > 1e-6 * normal[0][0] * size * size;
    const glm::dvec3 first = spread ? glm::inverse(normal)[0] : glm::dvec3(1.0 / normal[0][0], 0.0, 0.0);
    SmoothedValue result;
    double rays = 0.0;
    RgbSum variance(0.0);
    for (const Sample& s : samples_) {
        const double weight = s.rays * (first.x + first.y * s.x + first.z * s.y);
        result.value += weight * s.value;
        if (s.rays != rays) variance = pooledVariance(rays = s.rays);
        result.variance += weight * weight * variance;
    }
    return result;
}

RgbSum VertexSmoothing::Worker::pooledVariance(double rays) const {
    RgbSum sum(0.0);
    double count = 0.0;
    for (const Sample& s : samples_) {
        if (s.rays != rays) continue;
        sum += s.variance;
        count += 1.0;
    }
    return sum / count;
}

SmoothedValue VertexSmoothing::Worker::at(std::uint32_t vertex, std::span<const NoisyValue> values) {
    const OrthonormalBasis frame(smoothing_.mesh_.normals[vertex]);
    along_ = frame.x;
    across_ = frame.y;
    ++round_;
    samples_.clear();
    next_.assign(1, vertex);
    seen_[vertex] = round_;
    addRing(values, vertex);
    SmoothedValue best{RgbSum(values[vertex].value), RgbSum(values[vertex].variance)};
    SmoothedValue previous = best;
    RgbSum lowest(0.0), highest(0.0);
    for (int ring = 1; ring <= kMostRings && !next_.empty(); ++ring) {
        addRing(values, vertex);
        const SmoothedValue wider = fit();
        if (ring == 1) {
            best.variance = glm::max(best.variance, pooledVariance(samples_.front().rays));
            const RgbSum reach = kConfidence * glm::sqrt(best.variance);
            lowest = best.value - reach;
            highest = best.value + reach;
        }
        const RgbSum reach = kConfidence * glm::sqrt(wider.variance);
        lowest = glm::max(lowest, wider.value - reach);
        highest = glm::min(highest, wider.value + reach);
        if (lowest.x > highest.x || lowest.y > highest.y || lowest.z > highest.z) break;
        // What light that curves adds to a fit grows with the square of its reach: of it the last ring brought so much.
        const RgbSum change = wider.value - previous.value;
        const RgbSum noise = glm::max(previous.variance - wider.variance, RgbSum(0.0));
        const double growth = ring * ring / (2.0 * ring - 1.0);
        const RgbSum bias = growth * growth * glm::max(change * change - noise, RgbSum(0.0));
        best = {wider.value, kChosen * (wider.variance + change * change + bias)};
        previous = wider;
    }
    return best;
}

} // namespace lambert
