#include "comparison/form_factor_plots.h"

#include "comparison/page/figure_text.h"

#include <fmt/format.h>

#include <cmath>

namespace lambert {

namespace {

constexpr double kVaguestSlope = 0.3; ///< standard error of a slope that is still told

/// One point per effort: the mean over the seeds, its bar one standard deviation to both sides.
PlotCurve curve(const MethodResult& method, const Measure& cost, const Measure& error) {
    PlotCurve result;
    for (const EffortResult& effort : method.efforts) {
        const MeanDeviation y = effort.of(error);
        result.points.push_back({effort.of(cost).mean, y.mean, y.mean - y.deviation, y.mean + y.deviation});
    }
    const auto law = method.law(cost, error);
    result.label = law && law->exponentError <= kVaguestSlope
                       ? fmt::format("{}, slope {}", method.method->name, slopeText(law))
                       : method.method->name;
    return result;
}

bool isEmpty(const PlotCurve& curve) {
    for (const PlotCurve::Point& p : curve.points)
        if (p.x > 0.0 && p.y > 0.0) return false;
    return true;
}

/// A point without a bar.
PlotCurve::Point exactPoint(double x, double y) { return {x, y, y, y}; }

/// Adds `curveOf(method)` of each method that has one, in the method's style.
template <typename CurveOf>
void addCurves(Plot& plot, const FormFactorComparison& comparison, CurveOf curveOf) {
    int style = 0;
    for (const MethodResult& method : comparison.methods) {
        PlotCurve c = curveOf(method);
        c.style = style++;
        if (!isEmpty(c)) plot.curves.push_back(std::move(c));
    }
}

CaptionedPlot errorOverCost(const FormFactorComparison& comparison, const char* error, const char* cost,
                            const std::string& yLabel) {
    CaptionedPlot result;
    const bool overRays = cost == std::string("rays");
    result.plot.name = fmt::format("{}_over_{}", error, cost);
    result.plot.x = overRays ? PlotAxis{"rays", countText} : PlotAxis{"CPU seconds", numberLabel};
    result.plot.y = {yLabel, percentLabel};
    result.plot.description = fmt::format("{} against {}", measure(error).name, result.plot.x.label);
    addCurves(result.plot, comparison,
              [&](const MethodResult& method) { return curve(method, measure(cost), measure(error)); });
    return result;
}

/// The part that no other seed would mend.
CaptionedPlot systematic(const FormFactorComparison& comparison) {
    CaptionedPlot result;
    result.title = "Systematic error, by rays";
    result.plot.name = "systematic_over_rays";
    result.plot.description = "systematic part of the error against rays";
    result.plot.x = {"rays", countText};
    result.plot.y = {"systematic relative error", percentLabel};
    result.caption = "The part that is the same for every seed: one point in place of a whole patch, aliasing. "
                     "A method without bias has none but this estimate's noise; points below that are missing.";
    addCurves(result.plot, comparison, [](const MethodResult& method) {
        PlotCurve c{method.method->name, {}, 0};
        for (const EffortResult& effort : method.efforts)
            if (effort.systematic) c.points.push_back(exactPoint(effort.of(measure("rays")).mean, *effort.systematic));
        return c;
    });
    return result;
}

CaptionedPlot bySize(const FormFactorComparison& comparison) {
    CaptionedPlot result;
    result.title = "Error by the size of the factor";
    result.plot.name = "error_by_size";
    result.plot.description = "relative error against the size of the factors";
    result.plot.x = {"size of the factor, by half decades", numberLabel};
    result.plot.y = {"relative RMS error", percentLabel};
    result.caption =
        "Each method at its highest effort. A factor worth less than one ray gets nothing or far too much.";
    addCurves(result.plot, comparison, [](const MethodResult& method) {
        PlotCurve c{method.method->name, {}, 0};
        if (!method.efforts.empty())
            c.label = fmt::format("{} {}", c.label, effortNumber(method.efforts.back().effort));
        for (const FactorSizeError& size : method.bySize)
            c.points.push_back(exactPoint(std::sqrt(size.lower * size.upper), size.relativeRms));
        return c;
    });
    return result;
}

} // namespace

std::vector<CaptionedPlot> formFactorPlots(const FormFactorComparison& comparison) {
    const auto plot = [&](const char* error, const char* cost, const std::string& yLabel, const std::string& title,
                          const std::string& caption) {
        CaptionedPlot result = errorOverCost(comparison, error, cost, yLabel);
        result.title = title;
        result.caption = caption;
        return result;
    };
    std::vector<CaptionedPlot> plots{plot("relative_rms", "rays", "relative RMS error", "Factors, by rays",
                                          "Over the pairs whose factor is above the threshold."),
                                     plot("relative_rms", "cpu_seconds", "relative RMS error",
                                          "Factors, by processor time",
                                          "What a ray costs differs between the methods.")};
    if (comparison.referenceError && *comparison.referenceError > 0.0)
        for (CaptionedPlot& p : plots)
            p.plot.levels.push_back({"the reference's own error", *comparison.referenceError});
    if (comparison.lit)
        plots.push_back(plot("radiosity", "cpu_seconds", "relative RMS error", "Radiosity, by processor time",
                             "What matters in the end: the light solved from the matrix."));
    plots.push_back(plot("misdirected", "cpu_seconds", "share of the light", "Light sent astray, by processor time",
                         "What a row takes to a wrong place, mean over the area."));
    plots.push_back(systematic(comparison));
    plots.push_back(bySize(comparison));
    plots.push_back(
        plot("column_closure", "rays", "error of a column's sum", "Closure of the columns, by rays",
             "Needs no reference: how far from 1 that is which a patch receives if all surfaces send 1 per m²."));
    plots.push_back(plot("reciprocity", "rays", "relative RMS difference", "Reciprocity, by rays",
                         "Needs none either: how far A F from one side of a pair is from that of the other."));
    std::erase_if(plots, [](const CaptionedPlot& p) { return p.plot.curves.empty(); });
    return plots;
}

} // namespace lambert
