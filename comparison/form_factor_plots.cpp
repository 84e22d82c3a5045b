#include "comparison/form_factor_plots.h"

#include "comparison/form_factor_report.h"

#include <fmt/format.h>

#include <cmath>

namespace lambert {

namespace {

/// One point per effort: the mean over the seeds, its bar one standard deviation to both sides.
PlotCurve curve(const MethodResult& method, int style, const Measure& cost, const Measure& error) {
    PlotCurve result;
    for (const EffortResult& effort : method.efforts) {
        const MeanDeviation y = effort.of(error);
        result.points.push_back({effort.of(cost).mean, y.mean, y.mean - y.deviation, y.mean + y.deviation});
    }
    const auto law = method.law(cost, error);
    result.label = law ? fmt::format("{}, slope {}", method.method->name, slopeText(law)) : method.method->name;
    result.style = style;
    return result;
}

bool isEmpty(const PlotCurve& curve) {
    for (const PlotCurve::Point& p : curve.points)
        if (p.x > 0.0 && p.y > 0.0) return false;
    return true;
}

CaptionedPlot errorOverCost(const FormFactorComparison& comparison, const char* error, const char* cost,
                            const std::string& yLabel, const std::string& xLabel, const std::string& caption) {
    CaptionedPlot result;
    result.plot.name = fmt::format("{}_over_{}", error, cost);
    result.plot.description = yLabel + " against " + xLabel;
    result.plot.xLabel = xLabel;
    result.plot.yLabel = yLabel;
    result.caption = caption;
    int style = 0;
    for (const MethodResult& method : comparison.methods) {
        PlotCurve c = curve(method, style++, measure(cost), measure(error));
        if (!isEmpty(c)) result.plot.curves.push_back(std::move(c));
    }
    return result;
}

/// The part that no other seed would mend.
CaptionedPlot systematic(const FormFactorComparison& comparison) {
    CaptionedPlot result;
    result.plot.name = "systematic_over_rays";
    result.plot.description = "systematic part of the error against rays";
    result.plot.xLabel = "rays";
    result.plot.yLabel = "systematic relative error";
    result.caption =
        "The part of the error that is the same for every seed: one point in place of a whole patch, aliasing. "
        "A method without bias has none but the noise of this estimate.";
    int style = 0;
    for (const MethodResult& method : comparison.methods) {
        PlotCurve c{method.method->name, {}, style++};
        for (const EffortResult& effort : method.efforts)
            if (effort.systematic)
                c.points.push_back(
                    {effort.of(measure("rays")).mean, *effort.systematic, *effort.systematic, *effort.systematic});
        if (!isEmpty(c)) result.plot.curves.push_back(std::move(c));
    }
    return result;
}

CaptionedPlot bySize(const FormFactorComparison& comparison) {
    CaptionedPlot result;
    result.plot.name = "error_by_size";
    result.plot.description = "relative error against the size of the factors";
    result.plot.xLabel = "size of the factor, by half decades";
    result.plot.yLabel = "relative RMS error";
    result.caption =
        "Small factors err most. Each method at its highest effort; beyond its last ray a method gives a small "
        "factor nothing or far too much.";
    int style = 0;
    for (const MethodResult& method : comparison.methods) {
        PlotCurve c{method.method->name, {}, style++};
        if (!method.efforts.empty()) c.label += fmt::format(" {:g}", method.efforts.back().effort);
        for (const FactorSizeError& size : method.bySize)
            c.points.push_back(
                {std::sqrt(size.lower * size.upper), size.relativeRms, size.relativeRms, size.relativeRms});
        if (!isEmpty(c)) result.plot.curves.push_back(std::move(c));
    }
    return result;
}

} // namespace

std::vector<CaptionedPlot> formFactorPlots(const FormFactorComparison& comparison) {
    std::vector<CaptionedPlot> plots{
        errorOverCost(comparison, "relative_rms", "rays", "relative RMS error of the factors", "rays",
                      "Error per factor against rays, over the pairs whose factor is above the threshold."),
        errorOverCost(comparison, "relative_rms", "cpu_seconds", "relative RMS error of the factors", "CPU seconds",
                      "The same against processor time: what a ray costs differs between methods.")};
    if (comparison.lit)
        plots.push_back(errorOverCost(comparison, "radiosity", "cpu_seconds", "relative RMS error of the radiosity",
                                      "CPU seconds",
                                      "What matters in the end: the error of the light solved from the matrix."));
    plots.push_back(
        errorOverCost(comparison, "misdirected", "cpu_seconds", "share of the light sent astray", "CPU seconds",
                      "The share of a patch's light that its row takes to a wrong patch, mean over the area."));
    plots.push_back(systematic(comparison));
    plots.push_back(bySize(comparison));
    plots.push_back(
        errorOverCost(comparison, "column_closure", "rays", "closure error of the columns", "rays",
                      "Identities that need no reference: how far from 1 that is which a patch receives if all "
                      "surfaces send 1 per m²."));
    plots.push_back(errorOverCost(comparison, "reciprocity", "rays", "reciprocity error", "rays",
                                  "And how far A F from one side of a pair is from that of the other."));
    if (comparison.referenceError && *comparison.referenceError > 0.0)
        for (std::size_t k : {0U, 1U})
            plots[k].plot.levels.push_back({"the reference's own error", *comparison.referenceError});
    std::erase_if(plots, [](const CaptionedPlot& p) { return p.plot.curves.empty(); });
    return plots;
}

} // namespace lambert
