#include "comparison/vpl_report.h"

#include "comparison/page/figure_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace lambert {

using Json = nlohmann::ordered_json;

namespace {

struct Column {
    const char* key;
    const char* title;
    double FieldErrors::*value;
    bool relative; ///< already without a unit
};

constexpr std::array kColumns{Column{"bias", "bias", &FieldErrors::bias, false},
                              Column{"mean_absolute", "mean abs", &FieldErrors::meanAbsolute, false},
                              Column{"rms", "RMS", &FieldErrors::rms, false},
                              Column{"relative_rms", "rel. RMS", &FieldErrors::relativeRms, true},
                              Column{"percentile_99", "99 %", &FieldErrors::percentile99, false},
                              Column{"maximum", "maximum", &FieldErrors::maximum, false},
                              Column{"energy_ratio", "energy", &FieldErrors::energyRatio, true}};
constexpr std::array<const char*, 3> kChannels{"red", "green", "blue"};

Json meanJson(const MeanDeviation& value) { return {{"mean", value.mean}, {"deviation", value.deviation}}; }

Json rungJson(const VplRung& rung, double mean) {
    Json json{{"vpls", rung.effort},
              {"lights", meanJson(rung.of(&VplRun::lights))},
              {"rays", meanJson(rung.of(&VplRun::rays))},
              {"seconds", meanJson(rung.of(&VplRun::wallSeconds))},
              {"cpu_seconds", meanJson(rung.of(&VplRun::processorSeconds))}};
    for (const Column& column : kColumns) json[column.key] = meanJson(rung.of(column.value));
    json["relative_sampling"] = rung.sampling / mean;
    return json;
}

Json partJson(const ErrorPart& part, double mean) {
    return {{"part", part.approximation.part},
            {"share", part.share},
            {"share_error", part.shareError},
            {"relative_rms", part.rms / mean},
            {"relative_bias", part.bias / mean},
            {"relative_bias_error", part.biasError / mean},
            {"relative_rms_without", part.rmsWithout / mean},
            {"used", part.approximation.used},
            {"instead", part.approximation.instead}};
}

Json channelsJson(const VplRung& rung) {
    Json json = Json::object();
    for (std::size_t c = 0; c < 3; ++c)
        for (const Column& column : kColumns)
            json[kChannels[c]][column.key] =
                rung.of([&](const VplRun& run) { return run.errors.channels[c].*column.value; }).mean;
    return json;
}

Json lawJson(const std::optional<PowerLaw>& law) {
    return law ? Json{{"slope", law->exponent}, {"standard_error", law->exponentError}} : Json(nullptr);
}

Json bouncesJson(const std::vector<VplBounce>& bounces, const std::vector<ReferenceLight>& reference, double mean) {
    Json json = Json::array();
    for (std::size_t k = 0; k < bounces.size(); ++k) {
        Json bounce{{"bounce", k}, {"mean", bounces[k].of(&FieldErrors::mean).mean}};
        for (const Column& column : kColumns) bounce[column.key] = bounces[k].of(column.value).mean;
        bounce["own_error"] = reference[k].rms.total() / mean;
        bounce["significant"] = bounces[k].significant;
        json.push_back(bounce);
    }
    return json;
}

Json methodJson(const VplMethodResult& result, double mean) {
    const VplRung& main = result.ladder[result.main];
    Json json{{"name", result.method->name()}, {"vpls", main.effort}};
    json["seconds"] = main.of(&VplRun::wallSeconds).mean;
    for (const Column& column : kColumns) json[column.key] = main.of(column.value).mean;
    json["significant"] = result.significant;
    json["channels"] = channelsJson(main);
    Json options = Json::object();
    for (const auto& [name, value] : result.method->options()) options[name] = value;
    json["options"] = options;
    Json parts = Json::array();
    for (const ErrorPart& part : result.anatomy.parts) parts.push_back(partJson(part, mean));
    json["anatomy"] = parts;
    Json ladder = Json::array();
    for (const VplRung& rung : result.ladder) ladder.push_back(rungJson(rung, mean));
    json["ladder"] = ladder;
    json["sampling_slope"] = {{"over_lights", lawJson(samplingLaw(result, false))},
                              {"over_seconds", lawJson(samplingLaw(result, true))}};
    return json;
}

Json pictureJson(const ComparedPicture& picture) {
    Json json;
    for (const Column& column : kColumns) json[column.key] = picture.errors.overall.*column.value;
    json["psnr"] = std::isfinite(picture.psnr) ? Json(picture.psnr) : Json(nullptr);
    json["flip"] = picture.flip;
    json["seconds"] = picture.seconds;
    return json;
}

Json ownErrorJson(const OwnError& error, double mean) {
    return {{"mesh", error.mesh / mean},
            {"transport", error.transport / mean},
            {"gathering", error.gathering / mean},
            {"total", error.total() / mean}};
}

std::string partText(const ErrorPart& part, double mean) {
    return fmt::format(
        "  {:<12} {:>7.1f} % ± {:<5.1f} {:>12} {:>20} {:>14}   {}\n", part.approximation.part, 100.0 * part.share,
        100.0 * part.shareError, percentText(part.rms / mean),
        percentText(MeanDeviation{part.bias / mean, part.biasError / mean}), percentText(part.rmsWithout / mean),
        part.approximation.used.empty() ? std::string()
                                        : fmt::format("{} → {}", part.approximation.used, part.approximation.instead));
}

std::string bouncesText(const VplMethodResult& method, const std::vector<ReferenceLight>& reference, double mean) {
    std::string text =
        fmt::format("\nby bounce, relative to the mean of all light:\n  {:<12} {:>10} {:>18} {:>18} {:>18} {:>18}\n",
                    "reflected", "light", "bias", "RMS", "energy", "reference's error");
    for (std::size_t k = 0; k < method.bounces.size(); ++k) {
        const VplBounce& bounce = method.bounces[k];
        const auto relative = [&](double FieldErrors::*value) {
            const MeanDeviation found = bounce.of(value);
            return percentText(MeanDeviation{found.mean / mean, found.deviation / mean});
        };
        const MeanDeviation energy = bounce.of(&FieldErrors::energyRatio);
        text +=
            fmt::format("  {:<12} {:>10} {:>18} {:>18} {:>18} {:>18}{}\n",
                        k == 1 ? std::string("once") : fmt::format("{} times", k),
                        percentText(bounce.of(&FieldErrors::mean).mean / mean), relative(&FieldErrors::bias),
                        relative(&FieldErrors::rms), fmt::format("{:.4f} ± {:.4f}", energy.mean, energy.deviation),
                        percentText(reference[k].rms.total() / mean), bounce.significant ? "" : "  not significant");
    }
    return text;
}

} // namespace

std::optional<PowerLaw> samplingLaw(const VplMethodResult& method, bool overSeconds) {
    std::vector<double> cost, error;
    for (const VplRung& rung : method.ladder) {
        cost.push_back(rung.of(overSeconds ? &VplRun::processorSeconds : &VplRun::lights).mean);
        error.push_back(rung.sampling);
    }
    return fitPowerLaw(cost, error);
}

Json vplComparisonJson(const VplComparison& comparison, const VplPictures& pictures) {
    const double mean = comparison.meanIrradiance();
    const ReferenceLight& reference = comparison.reference;
    Json json;
    json["receivers"] = comparison.points.receivers.size();
    json["reference"] = {{"name", "patch radiosity"},
                         {"own_error", reference.rms.total() / mean},
                         {"own_error_parts", ownErrorJson(reference.rms, mean)},
                         {"own_error_of_mean", ownErrorJson(reference.mean, mean)},
                         {"mean", mean},
                         {"patches", comparison.referencePatches},
                         {"lines_per_patch", comparison.referenceLines},
                         {"imbalance", comparison.referenceImbalance},
                         {"order", reference.order},
                         {"order_found", reference.orderFound},
                         {"seconds", comparison.referenceSeconds}};
    Json methods = Json::array();
    for (std::size_t m = 0; m < comparison.methods.size(); ++m) {
        methods.push_back(methodJson(comparison.methods[m], mean));
        methods.back()["picture"] = pictureJson(pictures.methods[m]);
        if (const auto& bounces = comparison.methods[m].bounces; !bounces.empty())
            methods.back()["bounces"] = bouncesJson(bounces, comparison.referenceBounces, mean);
    }
    json["picture"] = {{"width", pictures.reference.width},
                       {"height", pictures.reference.height},
                       {"exposure_ev", pictures.exposure},
                       {"own_error", pictures.ownError}};
    json["methods"] = methods;
    return json;
}

std::string vplComparisonCsv(const VplComparison& comparison, std::uint64_t firstSeed) {
    std::string text = "method,vpls,seed,lights,rays,seconds,cpu_seconds";
    for (const Column& column : kColumns) text += fmt::format(",{}", column.key);
    text += '\n';
    for (const VplMethodResult& method : comparison.methods) {
        for (const VplRung& rung : method.ladder) {
            for (std::size_t k = 0; k < rung.runs.size(); ++k) {
                const VplRun& run = rung.runs[k];
                text += fmt::format("{},{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9g}", method.method->name(), rung.effort,
                                    firstSeed + k, run.lights, run.rays, run.wallSeconds, run.processorSeconds);
                for (const Column& column : kColumns) text += fmt::format(",{:.9g}", run.errors.overall.*column.value);
                text += '\n';
            }
        }
    }
    return text;
}

std::string vplComparisonText(const VplComparison& comparison) {
    const double mean = comparison.meanIrradiance();
    const double own = comparison.reference.rms.total();
    std::string text = fmt::format("{:<18} {:>8} {:>8} {:>8}", "method", "vpls", "lights", "CPU s");
    for (const Column& column : kColumns) text += fmt::format(" {:>10}", column.title);
    text += fmt::format(" {:>10}\n", "noise");
    for (const VplMethodResult& method : comparison.methods) {
        for (const VplRung& rung : method.ladder) {
            text += fmt::format("{:<18} {:>8} {:>8} {:>8.3g}", method.method->name(), countText(rung.effort),
                                countText(rung.of(&VplRun::lights).mean), rung.of(&VplRun::processorSeconds).mean);
            for (const Column& column : kColumns) {
                const double value = rung.of(column.value).mean;
                text += column.value == &FieldErrors::energyRatio
                            ? fmt::format(" {:>10.4f}", value)
                            : fmt::format(" {:>10}", percentText(column.relative ? value : value / mean));
            }
            text += fmt::format(" {:>10}{}\n", percentText(rung.sampling / mean),
                                rung.of(&FieldErrors::rms).mean > own ? "" : "  not significant");
        }
        if (const auto law = samplingLaw(method, false))
            text += fmt::format("{:<18} noise ~ lights^({}), seconds^({})\n", "", slopeText(law),
                                slopeText(samplingLaw(method, true)));
        text += fmt::format("\nanatomy of {} at {} vpls: relative RMS {}{}\n", method.method->name(),
                            countText(method.ladder[method.main].effort),
                            percentText(MeanDeviation{method.anatomy.rms / mean, method.anatomy.rmsError / mean}),
                            method.significant ? "" : ", not significant");
        text += fmt::format("  {:<12} {:>17} {:>12} {:>20} {:>14}   {}\n", "part", "share", "its RMS", "its bias",
                            "without it", "exchanged");
        for (const ErrorPart& part : method.anatomy.parts) text += partText(part, mean);
        if (!method.bounces.empty()) text += bouncesText(method, comparison.referenceBounces, mean);
        text += '\n';
    }
    const ReferenceLight& reference = comparison.reference;
    text += fmt::format("reference: patch radiosity, {} patches, {} lines each, extrapolated with order {:.2f} ({}), "
                        "energy imbalance {:.2g}\n",
                        fmt::join(comparison.referencePatches, ", "), comparison.referenceLines, reference.order,
                        reference.orderFound ? "found" : "assumed", comparison.referenceImbalance);
    text += fmt::format("its own error: {} (mesh {}, transport {}, gathering {})\n", percentText(own / mean),
                        percentText(reference.rms.mesh / mean), percentText(reference.rms.transport / mean),
                        percentText(reference.rms.gathering / mean));
    return text;
}

} // namespace lambert
