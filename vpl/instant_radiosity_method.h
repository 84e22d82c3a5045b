#pragma once

#include "vpl/gather.h"
#include "vpl/trace_lights.h"
#include "vpl/vpl_method.h"

namespace lambert {

struct InstantRadiosityChoice {
    Walk walk = Walk::Quasi;
    std::uint32_t bounces = 4;       //!< of fixed walks
    double bound = 10.0;             //!< see GatherOptions
    bool indirectShadows = true;     //!< false: lights that stand for reflected light shine through everything
    bool compensate = false;         //!< what the bound takes away is recovered
    std::uint32_t recoveryRays = 64; //!< per receiver, to compensate or to see what compensation would bring
};

/// Keller's instant radiosity: vpl/trace_lights.h and vpl/gather.h. Its effort is the number of particles.
class InstantRadiosityMethod : public VplMethod {
public:
    /// Throws UsageError for options out of range.
    explicit InstantRadiosityMethod(const InstantRadiosityChoice& choice);

    std::string name() const override { return "instant-radiosity"; }
    std::vector<std::pair<std::string, std::string>> options() const override;
    VplEffort effort() const override { return {"particles"}; }
    MethodLight light(const RayCaster& rays, const VplView& view, double effort, std::uint64_t seed,
                      Progress& progress) const override;
    /// Not of compensated light: what recovery finds is known only in sum.
    bool knowsBounces() const override { return !(choice_.compensate && clamps()); }
    std::vector<std::vector<RgbSum>> lightByBounce(const RayCaster& rays, const VplView& view, double effort,
                                                   std::uint64_t seed, std::uint32_t most,
                                                   Progress& progress) const override;
    std::vector<Approximation> approximations() const override;
    std::vector<std::vector<RgbSum>> exchanged(const RayCaster& rays, const VplView& view, double effort,
                                               std::uint64_t seed, Progress& progress) const override;

private:
    bool clamps() const;
    VirtualPointLights trace(const RayCaster& rays, double effort, std::uint64_t seed, Progress& progress) const;
    GatherOptions gathering(bool compensated, std::uint64_t seed) const;

    InstantRadiosityChoice choice_;
};

} // namespace lambert
