#include "comparison/form_factor_report.h"

#include "comparison/page/figure_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace lambert {

using Json = nlohmann::ordered_json;

namespace {

Json optional(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json effortJson(const EffortResult& effort) {
    Json json{{"effort", effort.effort}};
    for (const auto measures : {errorMeasures(), costMeasures()}) {
        for (const Measure& m : measures) {
            const MeanDeviation value = effort.of(m);
            json[m.key] = {{"mean", value.mean}, {"deviation", value.deviation}};
        }
    }
    json["systematic"] = optional(effort.systematic);
    return json;
}

Json slopesJson(const MethodResult& method) {
    Json json = Json::object();
    for (const Measure& error : errorMeasures()) {
        const auto law = method.law(measure("rays"), error);
        json[error.key] = law ? Json{{"slope", law->exponent}, {"standard_error", law->exponentError}} : Json(nullptr);
    }
    return json;
}

/// Columns of the terminal's table.
constexpr const char* kShown[] = {"relative_rms", "bias", "misdirected", "column_closure", "reciprocity", "radiosity"};

} // namespace

Json comparisonJson(const FormFactorComparison& comparison) {
    Json json;
    json["reference"] = {{"name", comparison.reference},
                         {"own_error", optional(comparison.referenceError)},
                         {"cpu_seconds", comparison.referenceSeconds}};
    json["threshold"] = comparison.threshold;
    json["lit"] = comparison.lit;
    Json methods = Json::array();
    for (const MethodResult& method : comparison.methods) {
        Json efforts = Json::array(), sizes = Json::array();
        for (const EffortResult& effort : method.efforts) efforts.push_back(effortJson(effort));
        for (const FactorSizeError& size : method.bySize)
            sizes.push_back({{"lower", size.lower},
                             {"upper", size.upper},
                             {"pairs", size.pairs},
                             {"relative_rms", size.relativeRms}});
        methods.push_back({{"name", method.method->name},
                           {"effort_name", method.method->effortName},
                           {"efforts", efforts},
                           {"slopes_over_rays", slopesJson(method)},
                           {"by_factor_size", sizes}});
    }
    json["methods"] = methods;
    return json;
}

std::string comparisonCsv(const FormFactorComparison& comparison, std::uint64_t firstSeed) {
    std::string text = "method,effort,seed";
    for (const auto measures : {errorMeasures(), costMeasures()})
        for (const Measure& m : measures) text += fmt::format(",{}", m.key);
    text += '\n';
    for (const MethodResult& method : comparison.methods) {
        for (const EffortResult& effort : method.efforts) {
            for (std::size_t k = 0; k < effort.runs.size(); ++k) {
                text += fmt::format("{},{},{}", method.method->name, effort.effort, firstSeed + k);
                for (const auto measures : {errorMeasures(), costMeasures()})
                    for (const Measure& m : measures) text += fmt::format(",{:.9g}", effort.runs[k].*m.value);
                text += '\n';
            }
        }
    }
    return text;
}

std::string comparisonText(const FormFactorComparison& comparison) {
    std::string text = fmt::format("{:<13} {:>8} {:>8} {:>8}", "method", "effort", "rays", "CPU s");
    for (const char* key : kShown) text += fmt::format(" {:>16}", measure(key).name);
    text += fmt::format(" {:>10}\n", "systematic");
    for (const MethodResult& method : comparison.methods) {
        for (const EffortResult& effort : method.efforts) {
            text += fmt::format("{:<13} {:>8} {:>8} {:>8.3g}", method.method->name, effortNumber(effort.effort),
                                countText(effort.of(measure("rays")).mean), effort.of(measure("cpu_seconds")).mean);
            for (const char* key : kShown)
                text += fmt::format(" {:>16}", !comparison.lit && key == std::string("radiosity")
                                                   ? "-"
                                                   : percentText(effort.of(measure(key)).mean));
            text += fmt::format(" {:>10}\n", effort.systematic ? percentText(*effort.systematic) : "-");
        }
        const auto law = method.law(measure("rays"), measure("relative_rms"));
        if (law) text += fmt::format("{:<13} relative RMS ~ rays^({})\n", "", slopeText(law));
    }
    text += fmt::format("reference: {}, own error {}\n", comparison.reference,
                        comparison.referenceError ? percentText(*comparison.referenceError) : "unknown");
    return text;
}

} // namespace lambert
