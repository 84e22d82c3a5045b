#include "vpl/instant_radiosity_method.h"

#include "vpl/recovery.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace lambert {

namespace {

using Field = std::vector<RgbSum>;

constexpr std::uint32_t kEveryBounce = std::numeric_limits<std::uint32_t>::max();

/// a + scale · (b − c).
Field moved(const Field& a, double scale, const Field& b, const Field& c) {
    Field result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] + scale * (b[i] - c[i]);
    return result;
}

/// With shadow rays that begin and end twice as far off the surfaces.
template <typename Points>
auto raised(const Points& points) {
    std::vector result(points.begin(), points.end());
    for (auto& point : result) point.lift *= 2.0F;
    return result;
}

/// Those on emitters keep their shadows, as with a shadow map.
std::vector<VirtualPointLight> withoutIndirectShadows(std::vector<VirtualPointLight> lights) {
    for (VirtualPointLight& light : lights) light.castsShadows = light.bounce == 0;
    return lights;
}

} // namespace

InstantRadiosityMethod::InstantRadiosityMethod(const InstantRadiosityChoice& choice) : choice_(choice) {
    checkGather({.bound = choice.bound});
}

bool InstantRadiosityMethod::clamps() const { return std::isfinite(choice_.bound); }

std::vector<std::pair<std::string, std::string>> InstantRadiosityMethod::options() const {
    std::string walk(nameOf(choice_.walk));
    if (choice_.walk == Walk::Fixed) walk += fmt::format(", {} bounces", choice_.bounces);
    std::string bound = clamps() ? fmt::format("{:g}/ℓ²", choice_.bound) : "none";
    if (clamps() && choice_.compensate) bound += fmt::format(", compensated by {} rays", choice_.recoveryRays);
    return {{"walk", walk},
            {"bound of the geometric term", bound},
            {"indirect shadows", choice_.indirectShadows ? "by rays" : "none"}};
}

VirtualPointLights InstantRadiosityMethod::trace(const RayCaster& rays, double effort, std::uint64_t seed,
                                                 Progress& progress) const {
    return traceLights(rays,
                       {.particles = static_cast<std::uint32_t>(effort),
                        .walk = choice_.walk,
                        .bounces = choice_.bounces,
                        .seed = seed},
                       progress);
}

GatherOptions InstantRadiosityMethod::gathering(bool compensated, std::uint64_t seed) const {
    return {.bound = choice_.bound, .recoveryRays = compensated && clamps() ? choice_.recoveryRays : 0, .seed = seed};
}

MethodLight InstantRadiosityMethod::light(const RayCaster& rays, const VplView& view, double effort, std::uint64_t seed,
                                          Progress& progress) const {
    VirtualPointLights traced = trace(rays, effort, seed, progress);
    if (!choice_.indirectShadows) traced.lights = withoutIndirectShadows(std::move(traced.lights));
    Gathered gathered =
        gatherIrradiance(rays, traced.lights, view.points, gathering(choice_.compensate, seed), progress);
    return {std::move(gathered.irradiance), traced.lights.size(),
            traced.rays + gathered.shadowRays + gathered.recoveryRays};
}

std::vector<Field> InstantRadiosityMethod::lightByBounce(const RayCaster& rays, const VplView& view, double effort,
                                                         std::uint64_t seed, std::uint32_t most,
                                                         Progress& progress) const {
    VirtualPointLights traced = trace(rays, effort, seed, progress);
    if (!choice_.indirectShadows) traced.lights = withoutIndirectShadows(std::move(traced.lights));
    GatherOptions options = gathering(false, seed);
    std::vector<Field> fields;
    for (std::uint32_t k = 0; k <= most; ++k) {
        options.direct = k == 0;
        fields.push_back(gatherIrradiance(rays, traced.ofBounces(k, k), view.points, options, progress).irradiance);
    }
    return fields;
}

std::vector<Approximation> InstantRadiosityMethod::approximations() const {
    const Approximation visibility =
        choice_.indirectShadows
            ? Approximation{"visibility", "shadow rays, begun off the surfaces", "without that gap (extrapolated)"}
            : Approximation{"visibility", "none of reflected light", "shadow rays"};
    return {
        visibility,
        {"clamping",
         clamps() ? choice_.compensate ? "bounded and compensated" : fmt::format("G ≤ {:g}/ℓ²", choice_.bound) : "none",
         clamps() && !choice_.compensate ? fmt::format("compensated by {} rays", choice_.recoveryRays)
                                         : "exact but for noise"},
        {"bounces",
         choice_.walk == Walk::Roulette ? "all"
         : choice_.walk == Walk::Fixed  ? fmt::format("{} bounces", choice_.bounces)
                                        : "until no particle is left",
         choice_.walk == Walk::Roulette ? "exact but for noise" : "all, by Russian roulette"}};
}

std::vector<Field> InstantRadiosityMethod::exchanged(const RayCaster& rays, const VplView& view, double effort,
                                                     std::uint64_t seed, Progress& progress) const {
    const std::span<const Receiver> receivers = view.points;
    const VirtualPointLights traced = trace(rays, effort, seed, progress);
    const auto gather = [&](std::span<const VirtualPointLight> lights, std::span<const Receiver> at, bool compensated) {
        return gatherIrradiance(rays, lights, at, gathering(compensated, seed), progress).irradiance;
    };
    std::vector<Field> fields;
    if (choice_.indirectShadows) {
        fields.push_back(gather(traced.lights, receivers, choice_.compensate));
        const Field bounded = choice_.compensate ? gather(traced.lights, receivers, false) : fields[0];
        const Field higher = gather(raised(traced.lights), raised(receivers), false);
        fields.push_back(moved(fields[0], -1.0, higher, bounded));
    } else {
        fields.push_back(gather(withoutIndirectShadows(traced.lights), receivers, choice_.compensate));
        fields.push_back(gather(traced.lights, receivers, choice_.compensate));
    }

    fields.push_back(fields.back());
    if (clamps() && !choice_.compensate) {
        const double largestTerm = largestGeometricTerm(rays.scene(), choice_.bound);
        const Recovered recovered =
            recoverLight(rays, traced.lights, receivers, largestTerm, gathering(true, seed), progress);
        for (std::size_t i = 0; i < receivers.size(); ++i) fields.back()[i] += recovered.irradiance[i];
    }

    fields.push_back(fields.back());
    if (choice_.walk != Walk::Roulette) {
        const auto followed = static_cast<std::uint32_t>(traced.particles.size());
        const VirtualPointLights endless = traceLights(
            rays, {.particles = static_cast<std::uint32_t>(effort), .walk = Walk::Roulette, .seed = seed}, progress);
        const auto later = endless.ofBounces(followed, kEveryBounce);
        // Both hold what lights without area give, and what emitters near give to rays that recover.
        fields.back() = moved(fields.back(), 1.0, gather(later, receivers, true), gather({}, receivers, true));
    }
    return fields;
}

} // namespace lambert
