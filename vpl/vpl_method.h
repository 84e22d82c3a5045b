#pragma once

#include "core/progress.h"
#include "picture/camera.h"
#include "scene/rays/ray_caster.h"
#include "solver/solution.h"
#include "vpl/receiver.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lambert {

/// The picture that points are seen in.
struct PictureView {
    Camera camera;
    int width = 0, height = 0;            //!< pixels
    std::span<const std::uint32_t> pixel; //!< #points: which one shows each, row by row from the top
};

/// Where light is wanted: at points of surfaces, which a picture may show.
struct VplView {
    std::span<const Receiver> points;
    std::optional<PictureView> picture{}; //!< none: they are no picture's
};

/// Something that a method does not do exactly, and what it can do instead.
struct Approximation {
    std::string part; //!< a short name: "clamping"
    std::string used; //!< what the method does: "G <= 10/ℓ²"
    std::string instead;
    bool onPicturesOnly = false; //!< it works on pixels: of points without a picture it changes nothing
};

/// What a method takes more of to be better.
struct VplEffort {
    std::string name; //!< "particles"
    double least = 1.0;
    double most = 16777216.0; //!< see TraceOptions
};

/// What a method found at points, and what it took.
struct MethodLight {
    std::vector<RgbSum> irradiance; //!< #points, E per m²
    std::uint64_t lights = 0;       //!< virtual point lights
    std::uint64_t rays = 0;
};

/// A way to find light by virtual point lights, as it is compared. One object stands for one choice of options but for its effort.
class VplMethod {
public:
    virtual ~VplMethod() = default;

    virtual std::string name() const = 0;                                         //!< as for --methods
    virtual std::vector<std::pair<std::string, std::string>> options() const = 0; //!< names and values, for people
    virtual VplEffort effort() const = 0;
    /// Of `wanted` runs with other seeds, how many tell anything new: 1 of a method without chance.
    virtual int seeds(int wanted) const { return wanted; }

    /// Efforts around `effort` that show how the error falls: by steps of four, ascending, each once.
    std::vector<double> ladder(double effort) const;

    /// The light at the points of a view of the scene of `rays`. The same for the same seed, whatever the number of threads. Throws
    /// Cancelled.
    virtual MethodLight light(const RayCaster& rays, const VplView& view, double effort, std::uint64_t seed,
                              Progress& progress) const = 0;

    /// Whether lightByBounce() is known.
    virtual bool knowsBounces() const { return false; }
    /// The parts of light() that were reflected 0, 1, ... `most` times on their way to the points: most + 1 fields.
    /// Only if knowsBounces().
    virtual std::vector<std::vector<RgbSum>> lightByBounce(const RayCaster& /*rays*/, const VplView& /*view*/,
                                                           double /*effort*/, std::uint64_t /*seed*/,
                                                           std::uint32_t /*most*/, Progress& /*progress*/) const {
        return {};
    }

    /// What it can exchange, beside its effort, in the order in which exchanged() does so.
    virtual std::vector<Approximation> approximations() const = 0;

    /// The same light, then that with the first of the approximations exchanged, with the first two, and so on: #approximations + 1
    /// fields. They share all random numbers that they can, so that their differences have little noise.
    virtual std::vector<std::vector<RgbSum>> exchanged(const RayCaster& rays, const VplView& view, double effort,
                                                       std::uint64_t seed, Progress& progress) const = 0;
};

} // namespace lambert
