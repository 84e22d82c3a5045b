#include "comparison/bake_comparison_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace lambert {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::array kMeasures{
    FieldMeasure{"mean", "mean of A", "Of A, weighted by the areas of its patches, as all means are.",
                 &FieldErrors::mean},
    FieldMeasure{"bias", "bias", "Mean of B − A.", &FieldErrors::bias},
    FieldMeasure{"mean_absolute", "mean abs", "Mean of |B − A|.", &FieldErrors::meanAbsolute},
    FieldMeasure{"rms", "RMS", "Root of the mean of (B − A)².", &FieldErrors::rms},
    FieldMeasure{"relative_rms", "rel. RMS", "RMS over the mean of A.", &FieldErrors::relativeRms},
    FieldMeasure{"percentile_99", "99 %", "|B − A| that 99 % of the area does not exceed.", &FieldErrors::percentile99},
    FieldMeasure{"maximum", "maximum", "The largest |B − A|.", &FieldErrors::maximum},
    FieldMeasure{"energy_ratio", "energy B/A", "Σ area · B over Σ area · A.", &FieldErrors::energyRatio}};

Json errorsJson(const FieldErrors& errors) {
    Json json;
    for (const FieldMeasure& m : kMeasures) json[m.key] = errors.*m.value;
    return json;
}

} // namespace

std::span<const FieldMeasure> fieldMeasures() { return kMeasures; }

std::array<NamedErrors, 4> namedErrors(const BakeComparison& c) {
    return {NamedErrors{"mean", c.overall}, NamedErrors{"red", c.channels[0]}, NamedErrors{"green", c.channels[1]},
            NamedErrors{"blue", c.channels[2]}};
}

Json bakeComparisonJson(const BakeComparison& comparison) {
    const auto rows = namedErrors(comparison);
    Json channels = Json::object();
    for (std::size_t k = 1; k < rows.size(); ++k) channels[rows[k].name] = errorsJson(rows[k].errors);
    return {{"same_patches", comparison.samePatches},
            {"unmatched_area", comparison.unmatchedArea},
            {"overall", errorsJson(comparison.overall)},
            {"channels", channels}};
}

std::string bakeComparisonCsv(const BakeComparison& comparison) {
    std::string text = "channel";
    for (const FieldMeasure& m : kMeasures) text += fmt::format(",{}", m.key);
    text += '\n';
    for (const NamedErrors& row : namedErrors(comparison)) {
        text += row.name;
        for (const FieldMeasure& m : kMeasures) text += fmt::format(",{:.9g}", row.errors.*m.value);
        text += '\n';
    }
    return text;
}

std::string bakeComparisonText(const BakeComparison& comparison) {
    std::string text = fmt::format("{:<8}", "");
    for (const FieldMeasure& m : kMeasures) text += fmt::format(" {:>11}", m.name);
    text += '\n';
    for (const NamedErrors& row : namedErrors(comparison)) {
        text += fmt::format("{:<8}", row.name);
        for (const FieldMeasure& m : kMeasures) text += fmt::format(" {:>11.5g}", row.errors.*m.value);
        text += '\n';
    }
    return text;
}

} // namespace lambert
