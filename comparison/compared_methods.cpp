#include "comparison/compared_methods.h"

#include "comparison/page/figure_text.h"
#include "core/error.h"
#include "scene/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

TransportOptions ComparedMethod::options(double effort, std::uint64_t seed, MatrixStorage storage) const {
    TransportOptions options;
    options.method = method;
    options.seed = seed;
    options.storage = storage;
    if (hasResolution(method)) options.resolution = static_cast<int>(effort);
    if (hasLines(method)) options.lines = static_cast<std::uint32_t>(effort);
    if (method == TransportMethod::ClosedForm) options.error = effort;
    if (method == TransportMethod::Auto) {
        options.rowError = effort;
        options.mostRays = 1e12; // as many as the error takes
    }
    return options;
}

TransportMatrix ComparedMethod::compute(const MeshedScene& scene, double effort, std::uint64_t seed,
                                        MatrixStorage storage, Progress& progress) const {
    const TransportPlan plan = planTransport(options(effort, seed, storage), scene.mesh, *scene.rays, progress);
    return computeMatrix(plan, scene.mesh, *scene.rays, progress);
}

std::span<const ComparedMethod> comparedMethods() {
    static const std::vector<ComparedMethod> kMethods = [] {
        using enum TransportMethod;
        std::vector<ComparedMethod> methods{
            {Auto, "", "error of a row", false, {0.1, 0.03, 0.01}, true, 1e-5, 0.5, 0},
            {Hemicube, "", "resolution", false, {16, 32, 64, 128}, true, 4, 4096, 2},
            {Hemisphere, "", "resolution", false, {16, 32, 64, 128}, true, 4, 4096, 4},
            {LocalLines, "", "lines per patch", true, {256, 1024, 4096, 16384}, true, 1, 1 << 24, 1},
            {GlobalLines, "", "lines in all", true, {250e3, 1e6, 4e6, 16e6}, true, 1, 4294967295.0, 1},
            {ClosedForm, "", "error", false, {0.1, 0.01, 0.001}, false, 1e-8, 0.1, 0}};
        for (ComparedMethod& method : methods) method.name = nameOf(method.method);
        return methods;
    }();
    return kMethods;
}

const ComparedMethod& comparedMethod(std::string_view name) {
    const auto methods = comparedMethods();
    const auto found = std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.name == name; });
    if (found != methods.end()) return *found;
    std::vector<std::string> names;
    for (const ComparedMethod& method : methods) names.push_back(method.name);
    throw UsageError(fmt::format("no method \"{}\": there are {}", name, fmt::join(names, ", ")));
}

std::string effortNumber(double effort) { return effort < 1e6 ? fmt::format("{:.9g}", effort) : countText(effort); }

std::string effortText(const ComparedMethod& method, double effort) {
    return method.numberFirst ? fmt::format("{} {}", effortNumber(effort), method.effortName)
                              : fmt::format("{} {}", method.effortName, effortNumber(effort));
}

double parseEffort(const ComparedMethod& method, const std::string& text) {
    const auto effort = parseNumber(text);
    if (effort && *effort >= method.lowest && *effort <= method.highest &&
        (!(method.multiple > 0.0) || std::fmod(*effort, method.multiple) == 0.0))
        return *effort;
    throw UsageError(fmt::format("{}, {}: found \"{}\", allowed is {:g} to {:.9g}{}", method.name, method.effortName,
                                 text, method.lowest, method.highest,
                                 method.multiple > 0.0 ? fmt::format(" in steps of {:g}", method.multiple) : ""));
}

} // namespace lambert
