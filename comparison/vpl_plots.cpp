#include "comparison/vpl_plots.h"

#include "comparison/page/figure_text.h"
#include "comparison/vpl_report.h"

#include <fmt/format.h>

namespace lambert {

namespace {

CaptionedPlot errorOverCost(const VplComparison& comparison, bool overSeconds) {
    const double mean = comparison.meanIrradiance();
    CaptionedPlot result;
    Plot& plot = result.plot;
    plot.name = overSeconds ? "error_over_cpu_seconds" : "error_over_lights";
    plot.x = overSeconds ? PlotAxis{"CPU seconds", numberLabel} : PlotAxis{"virtual point lights", countText};
    plot.y = {"relative RMS error", percentLabel};
    plot.description = fmt::format("relative RMS error against {}", plot.x.label);
    int style = 0;
    for (const VplMethodResult& method : comparison.methods) {
        PlotCurve error{method.method->name(), {}, style++};
        PlotCurve noise{method.method->name() + ", noise alone", {}, style++};
        if (const auto law = samplingLaw(method, overSeconds)) noise.label += ", slope " + slopeText(law);
        for (const VplRung& rung : method.ladder) {
            const double x = rung.of(overSeconds ? &VplRun::processorSeconds : &VplRun::lights).mean;
            const MeanDeviation y = rung.of(&FieldErrors::relativeRms);
            error.points.push_back({x, y.mean, y.mean - y.deviation, y.mean + y.deviation});
            noise.points.push_back({x, rung.sampling / mean, rung.sampling / mean, rung.sampling / mean});
        }
        plot.curves.push_back(std::move(error));
        if (method.method->seeds(2) > 1) plot.curves.push_back(std::move(noise));
    }
    const double own = comparison.reference.rms.total() / mean;
    plot.levels.push_back({"the reference's own error, " + percentText(own), own});
    return result;
}

} // namespace

std::vector<CaptionedPlot> vplPlots(const VplComparison& comparison) {
    CaptionedPlot lights = errorOverCost(comparison, false);
    lights.title = "By the number of lights";
    lights.caption =
        "Bars: one standard deviation over the seeds. Where the error flattens and its noise goes on falling, "
        "more lights do not help.";
    CaptionedPlot seconds = errorOverCost(comparison, true);
    seconds.title = "By processor time";
    seconds.caption = "Of tracing and of gathering at all receivers.";
    return {lights, seconds};
}

} // namespace lambert
