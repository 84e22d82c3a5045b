#pragma once

#include "lighting/solve_scene.h"
#include "solver/emitter_light.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

struct FinalGatherOptions {
    /// Aimed at for the standard error at a point, relative to the light there, or to a tenth of what most of the scene receives where
    /// there is less; 1e-4 to 1.
    double error = 0.01;
    std::uint64_t seed = 1;
};

/// Throws UsageError for options out of range.
void checkFinalGather(const FinalGatherOptions& options);

/// Patches with their light.
struct LitPatches {
    const PatchMesh& mesh;
    const PatchOptics& optics;
    const Scene& scene; //!< that `mesh` divides
    const RadiositySolution& solution;
    std::span<const Rgb> standardError{}; //!< #patches, of the irradiance; empty: unknown
};

LitPatches litPatches(const SolvedScene& scene);

/// Where light is gathered.
struct GatherPoint {
    glm::vec3 position; //!< metres
    glm::vec3 normal;   //!< unit length
    float lift;         //!< rays begin so far above it, metres
};

/// A point of a patch, or of its border, moved by `share` of the way to the patch's centre: one at a wall's foot is neither before nor
/// behind the wall, a little inside it is.
GatherPoint pointInside(const RayCaster& rays, const PatchMesh& mesh, std::uint32_t patch, const glm::vec3& position,
                        float share = 1e-3F);

/// The light at a point, as far as it is known.
struct GatheredLight {
    struct Part {
        RgbSum mean{0.0}, variance{0.0};
        double rays = 0.0;
        std::uint32_t round = 0;
        bool exact = false; //!< more rays would find nothing else

        void add(const RgbSum& value, const RgbSum& itsVariance, double count);
    };
    Part reflected, emitted, sky; //!< by surfaces, by all that emits, by the environment
    RgbSum exact{0.0};            //!< of lights without area
    RgbSum patchError{0.0};       //!< of what rays meet: as light varies within patches, and as the solution is noisy
    double covered = 0.0;         //!< share of the hemisphere that is closed by backs, 0 to 1

    RgbSum direct() const { return exact + emitted.mean + sky.mean; }
    RgbSum irradiance() const { return glm::max(reflected.mean + direct(), RgbSum(0.0)); } //!< E per m²
    RgbSum directVariance() const { return emitted.variance + sky.variance; }
    RgbSum standardError() const; //!< of rays and patches
    double rays() const { return reflected.rays + emitted.rays + sky.rays; }
};

/// The irradiance at points from the light of patches, found at the points themselves instead of between patches:
///
///     E(x) = E_0(x) + E_emitters(x) + (1/n²) Σ_rays ρ(y) E_patch(y)
///
/// E_0 is that of lights without area and of the environment (DirectLight), E_emitters that of all that emits (EmitterLight), both found
/// exactly but for what is hidden; what surfaces reflect is found by cosine-distributed rays, one in each of n² cells. Each of the three
/// takes more rays where its error is the largest, until the whole is as small as asked for.
///
/// The error of a cell is told from those beside it: of a block of 2 × 2 cells the square of f00 − f01 − f10 + f11, which is 0 where light
/// varies evenly, has the mean of their variances' sum.
class FinalGather {
public:
    /// All of `lit`, the scene's `rays` and the lights must be kept. Throws UsageError for options out of range.
    /// `variance`: #patches, see varianceWithin; or empty: nothing is said of patches' errors.
    FinalGather(const RayCaster& rays, const LitPatches& lit, const LightSources& sources, std::vector<Rgb> variance,
                const FinalGatherOptions& options);

    // Thread-safe. Points of different `index` have random numbers of their own.

    /// As good as asked for.
    GatheredLight at(const GatherPoint& point, std::uint32_t index) const;
    /// By few rays each.
    GatheredLight begin(const GatherPoint& point, std::uint32_t index) const;
    /// Direct light as good as asked for, less `share` of the allowed variance.
    void refineDirect(const GatherPoint& point, std::uint32_t index, double share, GatheredLight& light) const;
    /// Four times as many rays to surfaces.
    void refineReflected(const GatherPoint& point, std::uint32_t index, GatheredLight& light) const;

    const FinalGatherOptions& options() const { return options_; }
    /// A standard error over the channels, as FinalGatherOptions::error has it.
    double relative(double error, const RgbSum& irradiance) const {
        return error > 0.0 ? error / std::max(sumOf(irradiance), least_) : 0.0;
    }

private:
    using Part = GatheredLight::Part;
    /// The standard error that is allowed where there is so much light, over the channels.
    double allowedError(const RgbSum& irradiance) const { return options_.error * std::max(sumOf(irradiance), least_); }
    RgbSum errorOfPatches(std::span<std::uint32_t> met) const;
    void emitted(const GatherPoint& point, std::uint32_t index, Part& part) const;
    void fromSky(const GatherPoint& point, std::uint32_t index, Part& part) const;

    const RayCaster& rays_;
    const PatchMesh& mesh_;
    std::span<const RgbSum> irradiance_;
    LightSources sources_;
    FinalGatherOptions options_;
    EmitterLight emitters_;
    std::vector<Rgb> reflected_; ///< #patches, ρ E
    std::vector<Rgb> variance_;  ///< #patches, of ρ E as a part of the patch has it; or empty
    std::vector<bool> varied_;   ///< #polygons: ρ varies over it
    double least_ = 0.0;         ///< light of which the error is a share at least, over the channels
};

} // namespace lambert
