#include "comparison/compared_methods.h"

#include "comparison/figure_text.h"
#include "core/error.h"
#include "formfactors/closed_form_method.h"
#include "formfactors/global_lines.h"
#include "formfactors/hemicube.h"
#include "formfactors/hemisphere.h"
#include "formfactors/local_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lambert {

namespace {

ComputedMatrix allRows(const FormFactorMethod& method, MatrixStorage storage, Progress& progress) {
    return {computeMatrix(method, storage, progress), method.raysPerRow() * method.patchCount()};
}

ComputedMatrix hemicube(const MeshedScene& s, double effort, std::uint64_t seed, MatrixStorage storage,
                        Progress& progress) {
    return allRows(Hemicube(s.mesh, *s.rays, {.resolution = static_cast<int>(effort), .seed = seed}), storage,
                   progress);
}

ComputedMatrix hemisphere(const MeshedScene& s, double effort, std::uint64_t seed, MatrixStorage storage,
                          Progress& progress) {
    return allRows(Hemisphere(s.mesh, *s.rays, {.resolution = static_cast<int>(effort), .seed = seed}), storage,
                   progress);
}

ComputedMatrix localLines(const MeshedScene& s, double effort, std::uint64_t seed, MatrixStorage storage,
                          Progress& progress) {
    return allRows(LocalLines(s.mesh, *s.rays, {.lines = static_cast<std::uint32_t>(effort), .seed = seed}), storage,
                   progress);
}

ComputedMatrix globalLines(const MeshedScene& s, double effort, std::uint64_t seed, MatrixStorage storage,
                           Progress& progress) {
    const LineCaster caster(*s.scene);
    const GlobalLines lines(s.mesh, caster, {.lines = static_cast<std::uint32_t>(effort), .seed = seed});
    return {lines.matrix(storage, progress), static_cast<std::uint64_t>(effort)};
}

ComputedMatrix closedForm(const MeshedScene& s, double effort, std::uint64_t, MatrixStorage storage,
                          Progress& progress) {
    return allRows(ClosedForm(s.mesh, *s.rays, {.error = effort}), storage, progress);
}

} // namespace

std::span<const ComparedMethod> comparedMethods() {
    static const std::vector<ComparedMethod> kMethods{
        {"hemicube", "resolution", false, {16, 32, 64, 128}, true, 16, 4096, 2, hemicube},
        {"hemisphere", "resolution", false, {16, 32, 64, 128}, true, 4, 4096, 4, hemisphere},
        {"local-lines", "lines per patch", true, {256, 1024, 4096, 16384}, true, 1, 1 << 24, 1, localLines},
        {"global-lines", "lines in all", true, {250e3, 1e6, 4e6, 16e6}, true, 1, 4294967295.0, 1, globalLines},
        {"closed-form", "error", false, {0.1, 0.01, 0.001}, false, 1e-8, 0.1, 0, closedForm}};
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
    double effort = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), effort);
    const bool whole = !(method.multiple > 0.0) || std::fmod(effort, method.multiple) == 0.0;
    if (error == std::errc() && end == text.data() + text.size() && effort >= method.lowest &&
        effort <= method.highest && whole)
        return effort;
    throw UsageError(fmt::format("{}, {}: found \"{}\", allowed is {:g} to {:.9g}{}", method.name, method.effortName,
                                 text, method.lowest, method.highest,
                                 method.multiple > 0.0 ? fmt::format(" in steps of {:g}", method.multiple) : ""));
}

} // namespace lambert
