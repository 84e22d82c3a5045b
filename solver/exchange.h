#pragma once

#include "scene/scene.h"
#include "solver/fixed_point_sum.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// What a patch sends in one exchange, and by how many lines.
struct Sender {
    Rgb excess{0.0F};     //!< B − β per m²
    float density = 0.0F; //!< expected local lines that start per m²; > 0 wherever `excess` is not 0
};

/// One step of light from patches to patches, as a random estimate by lines.
///
/// With a constant control variate β, F B = β (1 − F_back − F_out) + F (B − β): what is not a front counts as a patch of excess
/// −β. An exchange finds an unbiased estimate of A_i Σ_j F_ij (B_j − β) for every patch i, with j also the black backs and the
/// outside; so E_i = β + received_i / A_i.
struct ExchangeInput {
    std::span<const Sender> senders; //!< #patches
    Rgb control{0.0F};               //!< β
    std::uint64_t seed = 0;          //!< of the sequences of lines; the same for all iterations that continue them
    std::uint32_t iteration = 0;
};

/// What left the patches' fronts and met no other front, in units of power.
struct Losses {
    RgbSum backFaces{0.0}; //!< estimates Σ A B F_back
    RgbSum escaped{0.0};   //!< estimates Σ A B F_out

    Losses& operator+=(const Losses& other) {
        backFaces += other.backFaces;
        escaped += other.escaped;
        return *this;
    }
};

/// Losses as integers; one per thread.
struct LossUnits {
    glm::vec<3, std::int64_t> backFaces{0}, escaped{0};

    void add(bool back, const Rgb& value, const FixedPointScale& scale) {
        for (int c = 0; c < 3; ++c) (back ? backFaces : escaped)[c] += scale.units(static_cast<double>(value[c]));
    }
    void operator+=(const LossUnits& other) {
        backFaces += other.backFaces;
        escaped += other.escaped;
    }
    Losses value(const FixedPointScale& scale) const {
        Losses losses;
        for (int c = 0; c < 3; ++c) {
            losses.backFaces[c] = scale.value(backFaces[c]);
            losses.escaped[c] = scale.value(escaped[c]);
        }
        return losses;
    }
};

/// How many lines left each patch's front, and how many of these met black backs.
class LineCounts {
public:
    explicit LineCounts(std::size_t patches) : lines_(patches, 0), backs_(patches, 0) {}

    void addLines(std::size_t patch, std::uint64_t count) { increase(lines_[patch], count); } ///< from any thread
    void addBack(std::size_t patch) { increase(backs_[patch], 1); }                           ///< from any thread

    /// An estimate of F_back; 0 if there were no lines.
    float backShare(std::size_t patch) const {
        return lines_[patch] > 0 ? static_cast<float>(backs_[patch]) / static_cast<float>(lines_[patch]) : 0.0F;
    }

    /// Passes the counts to an archive, see SolverCheckpoint.
    template <typename Archive>
    void keep(Archive& archive) {
        archive(lines_);
        archive(backs_);
    }

private:
    static void increase(std::uint64_t& number, std::uint64_t by) {
        std::atomic_ref(number).fetch_add(by, std::memory_order_relaxed);
    }
    std::vector<std::uint64_t> lines_, backs_;
};

/// The largest magnitude of the channels.
inline double largest(const Rgb& colour) {
    return static_cast<double>(std::max({std::abs(colour.x), std::abs(colour.y), std::abs(colour.z)}));
}

/// A maximum as a sum, for orderedSum().
struct Maximum {
    double value = 0.0;
    Maximum& operator+=(const Maximum& other) {
        value = std::max(value, other.value);
        return *this;
    }
};

} // namespace lambert
