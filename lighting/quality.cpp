#include "lighting/quality.h"

#include "core/error.h"

#include <fmt/format.h>

#include <array>

namespace lambert {

namespace {

constexpr std::array kQualities{Quality{"preview", 0.2, 64, 0.2e9, 1e-3, 1024, 512, 1.0},
                                Quality{"normal", 1.0, 128, 1.3e9, 1e-4, 4096, 4096, 1.0},
                                Quality{"high", 4.0, 192, 1.2e10, 1e-5, 32768, 16384, 0.5}};

} // namespace

const Quality& qualityOf(std::string_view name) {
    for (const Quality& quality : kQualities)
        if (quality.name == name) return quality;
    throw UsageError(fmt::format("quality: found \"{}\", allowed are preview, normal and high", name));
}

SolveOptions solveOptions(const Quality& quality, std::uint64_t seed) {
    FormFactorLight light;
    light.formFactors.transport.largestResolution = quality.largestResolution;
    light.formFactors.transport.mostRays = quality.mostRays;
    light.formFactors.transport.seed = seed;
    light.solver.tolerance = quality.tolerance;
    SolveOptions options;
    options.mesh.refinement = quality.refinement;
    options.directLight.skyRays = quality.skyRays;
    options.directLight.seed = seed;
    options.method = std::move(light);
    return options;
}

} // namespace lambert
