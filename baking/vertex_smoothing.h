#pragma once

#include "baking/baked_mesh.h"
#include "core/rgb.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// A value that was found at a vertex by random rays.
struct NoisyValue {
    Rgb value{0.0F}, variance{0.0F};
    std::uint32_t rays = 0; //!< 0: there is none
};

struct SmoothedValue {
    RgbSum value{0.0}, variance{0.0}; //!< the latter of noise and of what the neighbours may differ
};

/// Values at vertices from those found there and around: a linear function of the place, fitted to the vertices that are no more
/// than k edges away on the same smoothing side, k as large as the fits to smaller neighbourhoods allow: as long as the intervals
/// of all of them, plus and minus .7 standard errors, have a point in common. So values that vary evenly are averaged over
/// many vertices, and those beside an edge of light over few or none.
///
/// Intersection of confidence intervals: A. Goldenshluger, A. Nemirovski, "On spatially adaptive estimation of nonparametric
/// regression", Mathematical Methods of Statistics 6(2), 1997; V. Katkovnik, "A new method for varying adaptive bandwidth
/// selection", IEEE Transactions on Signal Processing 47(9), 1999.
class VertexSmoothing {
public:
    /// `mesh` must be kept.
    explicit VertexSmoothing(const BakedMesh& mesh);

    /// Memory for one thread.
    class Worker {
    public:
        explicit Worker(const VertexSmoothing& smoothing)
            : smoothing_(smoothing), seen_(smoothing.mesh_.positions.size(), 0) {}
        /// Of `values`, #vertices.
        SmoothedValue at(std::uint32_t vertex, std::span<const NoisyValue> values);

    private:
        struct Sample {
            double x, y, rays;
            RgbSum value, variance;
        };
        void addRing(std::span<const NoisyValue> values, std::uint32_t vertex);
        SmoothedValue fit() const;
        RgbSum pooledVariance(double rays) const; ///< of the samples of so many

        const VertexSmoothing& smoothing_;
        std::vector<std::uint32_t> seen_; ///< #vertices, the round in which it was
        std::uint32_t round_ = 0;
        std::vector<std::uint32_t> ring_, next_;
        std::vector<Sample> samples_;
        glm::vec3 along_{0.0F}, across_{0.0F};
    };

private:
    std::span<const std::uint32_t> neighbours(std::uint32_t vertex) const {
        return std::span(neighbours_).subspan(begin_[vertex], begin_[vertex + 1] - begin_[vertex]);
    }

    const BakedMesh& mesh_;
    std::vector<std::uint32_t> begin_;      ///< #vertices + 1, into neighbours_
    std::vector<std::uint32_t> neighbours_; ///< with repetitions
};

} // namespace lambert
