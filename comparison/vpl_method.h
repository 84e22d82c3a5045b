#pragma once

#include "core/progress.h"
#include "scene/ray_caster.h"
#include "solver/solution.h"
#include "vpl/receiver.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lambert {

/// Something that a method does not do exactly, and what it can do instead.
struct Approximation {
    std::string part; //!< a short name: "clamping"
    std::string used; //!< what the method does: "G <= 10/ℓ²"
    std::string instead;
};

/// What a method found at receivers, and what it took.
struct MethodLight {
    std::vector<RgbSum> irradiance; //!< #receivers, E per m²
    std::uint64_t lights = 0;       //!< virtual point lights
    std::uint64_t rays = 0;
};

/// A way to find light by virtual point lights, as it is compared. One object stands for one choice of options but for the number of
/// lights, its effort.
class VplMethod {
public:
    virtual ~VplMethod() = default;

    virtual std::string name() const = 0;                                         //!< as for --methods
    virtual std::vector<std::pair<std::string, std::string>> options() const = 0; //!< names and values, for people
    virtual bool isRandom() const { return true; }                                //!< other seeds give other light

    /// The light at receivers in the scene of `rays`. The same for the same seed, whatever the number of threads. Throws Cancelled.
    virtual MethodLight light(const RayCaster& rays, std::span<const Receiver> receivers, double effort,
                              std::uint64_t seed, Progress& progress) const = 0;

    /// Whether lightByBounce() is known.
    virtual bool knowsBounces() const { return false; }
    /// The parts of light() that were reflected 0, 1, ... `most` times on their way to the receivers: most + 1 fields.
    /// Only if knowsBounces().
    virtual std::vector<std::vector<RgbSum>> lightByBounce(const RayCaster& /*rays*/,
                                                           std::span<const Receiver> /*receivers*/, double /*effort*/,
                                                           std::uint64_t /*seed*/, std::uint32_t /*most*/,
                                                           Progress& /*progress*/) const {
        return {};
    }

    /// What it can exchange, beside the number of lights, in the order in which exchanged() does so.
    virtual std::vector<Approximation> approximations() const = 0;

    /// The same light, then that with the first of the approximations exchanged, with the first two, and so on: #approximations + 1
    /// fields. They share all random numbers that they can, so that their differences have little noise.
    virtual std::vector<std::vector<RgbSum>> exchanged(const RayCaster& rays, std::span<const Receiver> receivers,
                                                       double effort, std::uint64_t seed, Progress& progress) const = 0;
};

} // namespace lambert
