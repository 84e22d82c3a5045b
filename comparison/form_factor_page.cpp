#include "comparison/form_factor_page.h"

#include "baking/exposure.h"
#include "comparison/form_factor_plots.h"
#include "comparison/page/figure_text.h"
#include "comparison/page/html_page.h"
#include "comparison/page/page_files.h"
#include "comparison/page/scale_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

namespace lambert {

namespace {

constexpr int kMostDecades = 2; ///< of a false-colour scale
constexpr std::size_t kMostTargets = 8;

/// The places of the smallest value, within what is shown of it.
void markSmallest(std::vector<std::vector<HtmlCell>>& rows, std::size_t column, const std::vector<double>& values) {
    const double smallest = *std::min_element(values.begin(), values.end());
    for (std::size_t k = 0; k < values.size(); ++k)
        if (std::isfinite(values[k]) && values[k] <= smallest * 1.005) rows[k][column].strong = true;
}

class PageBuilder {
public:
    PageBuilder(const FormFactorPageInput& input, Progress& progress)
        : in_(input), of_(input.comparison), progress_(progress), page_("Form factors of " + input.scene, subtitle()) {}

    std::vector<FileContent> operator()() {
        page_.figureAndTable({"", files_.picture("scene", scenePicture(), in_.scene), sceneCaption()}, facts());
        summary();
        if (!of_.methods.empty()) costs();
        plots();
        pictures("misdirected", "Where the light goes astray",
                 "Share of the light of each patch that its row sends to a wrong patch, one scale for all methods, "
                 "each at its "
                 "highest effort.",
                 &MethodResult::misdirectedBy);
        pictures("closure", "Closure per patch",
                 "How far from 1 that is which a patch receives if every surface sends 1 per m² (the column's "
                 "closure); rows of "
                 "methods that count lines or pixels close by themselves.",
                 &MethodResult::columnClosure);
        details();
        reading();
        return files_.with(page_);
    }

private:
    std::string subtitle() const {
        std::vector<std::string> names;
        for (const MethodResult& method : in_.comparison.methods) names.push_back(method.method->name);
        return fmt::format("{} against {}, on {} patches", fmt::join(names, ", "), in_.comparison.reference,
                           in_.meshed.mesh.size());
    }

    Image scenePicture() {
        if (!of_.lit)
            return headlightPicture(in_.meshed.mesh, in_.meshed.optics, *in_.meshed.rays, in_.camera, in_.size,
                                    progress_);
        const BakedMesh baked =
            reconstructAverage({in_.meshed.mesh, in_.meshed.optics, *in_.meshed.scene, of_.referenceSolution}, {});
        RenderOptions options{in_.size};
        options.toneMapExposure = automaticExposure(baked, Quantity::Radiosity);
        return renderBaked(in_.meshed.mesh, baked, *in_.meshed.rays, in_.camera, options, progress_);
    }

    std::string sceneCaption() const {
        return of_.lit ? "The scene in the light of the reference's solution."
                       : "The scene, which has no light, lit from the camera: no radiosity is compared.";
    }

    HtmlTable facts() const {
        const PatchMesh& mesh = in_.meshed.mesh;
        const double area = std::accumulate(mesh.area.begin(), mesh.area.end(), 0.0);
        HtmlTable table;
        table.add("Scene", in_.scene);
        table.add("Patches", fmt::format("{}, {:.4g} m² in all, from {} polygons", mesh.size(), area,
                                         in_.meshed.scene->polygons.size()));
        if (std::isfinite(in_.meshed.meshReport.patchLength))
            table.add("Longest edge", fmt::format("{:.4g} m", in_.meshed.meshReport.patchLength));
        table.add("Reference", of_.reference);
        table.add("Its own error", !of_.referenceError ? "unknown"
                                   : *of_.referenceError > 0
                                       ? percentText(*of_.referenceError) + ": errors below it tell nothing"
                                       : "none but rounding");
        table.add("Its cost", fmt::format("{:.3g} CPU seconds", of_.referenceSeconds));
        table.add("Threshold", fmt::format("relative errors count factors from {:.3g}", of_.threshold));
        for (const auto& [name, value] : in_.facts) table.add(name, value);
        return table;
    }

    /// Each method at its highest effort.
    void summary() {
        page_.section("What each method reaches");
        std::vector<const Measure*> columns;
        for (const char* key : {"relative_rms", "misdirected", "radiosity", "column_closure", "reciprocity"})
            if (of_.lit || key != std::string_view("radiosity")) columns.push_back(&measure(key));
        HtmlTable table;
        table.caption =
            fmt::format("At the highest effort that was compared; mean and standard deviation over {} seeds.", seeds());
        table.dense = true;
        table.head = {"method", "effort", measure("rays").name, measure("cpu_seconds").name};
        for (const Measure* m : columns) table.head.emplace_back(m->name);
        table.head.insert(table.head.end(), {"systematic", "slope over rays"});
        for (const MethodResult& method : of_.methods) {
            const EffortResult& last = method.efforts.back();
            std::vector<HtmlCell> row{method.method->name, effortText(*method.method, last.effort),
                                      countText(last.of(measure("rays")).mean),
                                      fmt::format("{:.3g}", last.of(measure("cpu_seconds")).mean)};
            for (const Measure* m : columns) row.emplace_back(percentText(last.of(*m)));
            row.emplace_back(last.systematic ? percentText(*last.systematic) : "–");
            row.emplace_back(slopeText(method.law(measure("rays"), measure("relative_rms"))));
            table.rows.push_back(row);
        }
        for (std::size_t c = 0; c < columns.size() && of_.methods.size() > 1; ++c) {
            std::vector<double> values;
            for (const MethodResult& method : of_.methods) values.push_back(method.efforts.back().of(*columns[c]).mean);
            markSmallest(table.rows, 4 + c, values);
        }
        page_.table(table);
    }

    std::size_t seeds() const {
        std::size_t most = 0;
        for (const MethodResult& method : of_.methods) most = std::max(most, method.efforts.front().runs.size());
        return most;
    }

    /// Round errors between the smallest and the largest that were met.
    std::vector<double> targets(const Measure& error) const {
        double smallest = INFINITY;
        double largest = 0.0;
        for (const MethodResult& method : of_.methods) {
            for (const double value : method.means(error)) {
                if (value > 0.0) smallest = std::min(smallest, value);
                largest = std::max(largest, value);
            }
        }
        std::vector<double> result;
        if (!(smallest > 0.0)) return {};
        for (int n = stepBelow(largest); roundStep(n) > smallest && result.size() < kMostTargets; --n)
            result.push_back(roundStep(n));
        return result;
    }

    void costs() {
        const Measure& error = measure(of_.lit ? "radiosity" : "relative_rms");
        const std::vector<double> wanted = targets(error);
        if (wanted.empty()) return;
        page_.section("Which to use when");
        HtmlTable table;
        table.caption = fmt::format("CPU seconds to an error of the {}, between what was measured by power laws; ≤ "
                                    "where the least effort reaches it already.",
                                    of_.lit ? "radiosity" : "factors");
        table.head = {"method"};
        for (const double target : wanted) table.head.push_back(percentLabel(target));
        std::vector<std::vector<double>> seconds(wanted.size());
        for (const MethodResult& method : of_.methods) {
            std::vector<HtmlCell> row{method.method->name};
            const std::vector<double> cost = method.means(measure("cpu_seconds"));
            const std::vector<double> errors = method.means(error);
            for (std::size_t t = 0; t < wanted.size(); ++t) {
                const auto needed = costToReach(wanted[t], cost, errors);
                const bool atOnce = errors.front() <= wanted[t];
                seconds[t].push_back(needed ? *needed : atOnce ? cost.front() : INFINITY);
                row.emplace_back(needed   ? fmt::format("{:.2g}", *needed)
                                 : atOnce ? fmt::format("≤ {:.2g}", cost.front())
                                          : "not reached");
            }
            table.rows.push_back(row);
        }
        for (std::size_t t = 0; t < wanted.size(); ++t) markSmallest(table.rows, t + 1, seconds[t]);
        page_.table(table);
    }

    void plots() {
        page_.section("Error against cost");
        std::vector<HtmlFigure> figures;
        for (const CaptionedPlot& p : formFactorPlots(of_))
            figures.push_back({p.title, files_.plot(p.plot, progress_), p.caption});
        page_.figures(figures, 2);
    }

    void pictures(const std::string& name, const std::string& heading, const std::string& text,
                  std::vector<float> MethodResult::*values) {
        std::vector<float> all;
        for (const MethodResult& method : of_.methods)
            all.insert(all.end(), (method.*values).begin(), (method.*values).end());
        const ColourScale scale(all, kMostDecades);
        page_.section(heading);
        page_.paragraph(text);
        std::vector<HtmlFigure> figures;
        for (const MethodResult& method : of_.methods) {
            const Image image =
                patchPicture(in_.meshed.mesh, *in_.meshed.rays, method.*values, scale, in_.camera, in_.size, progress_);
            const std::string title =
                fmt::format("{} {}", method.method->name, effortNumber(method.efforts.back().effort));
            figures.push_back(
                {title, files_.picture(name + "_" + method.method->name, image, heading + ": " + title, &scale), ""});
        }
        const std::size_t count = figures.size();
        page_.figures(figures, count == 4 ? 4 : count < 3 ? 2 : 3);
        page_.figures({{"", scaleBarSvg(scale, name), ""}}, 1);
    }

    void details() {
        page_.section("All figures");
        HtmlTable table;
        table.dense = true;
        table.caption =
            fmt::format("Means over {} seeds. results.csv has every run, results.json the deviations.", seeds());
        table.head = {"method", "effort"};
        for (const Measure& m : costMeasures()) table.head.emplace_back(m.name);
        for (const Measure& m : errorMeasures())
            if (of_.lit || m.key != std::string_view("radiosity")) table.head.emplace_back(m.name);
        table.head.emplace_back("systematic");
        for (const MethodResult& method : of_.methods) {
            for (const EffortResult& effort : method.efforts) {
                std::vector<HtmlCell> row{method.method->name, effortNumber(effort.effort)};
                for (const Measure& m : costMeasures()) {
                    const double mean = effort.of(m).mean;
                    row.emplace_back(m.name == std::string_view("rays") || m.name == std::string_view("bytes")
                                         ? countText(mean)
                                         : fmt::format("{:.3g}", mean));
                }
                for (const Measure& m : errorMeasures()) {
                    if (!of_.lit && m.key == std::string_view("radiosity")) continue;
                    const bool absolute = m.key == std::string_view("rms") || m.key == std::string_view("maximum");
                    const double mean = effort.of(m).mean;
                    row.emplace_back(absolute ? fmt::format("{:.2e}", mean) : percentText(mean));
                }
                row.emplace_back(effort.systematic ? percentText(*effort.systematic) : "–");
                table.rows.push_back(row);
            }
            if (&method != &of_.methods.back()) table.rows.emplace_back();
        }
        page_.table(table);
    }

    void reading() {
        page_.section("What the figures mean");
        std::vector<HtmlPage::Definition> definitions{
            {"error bars", "One standard deviation to both sides, over the seeds."},
            {"slope",
             "Of the line of least squares through the logarithms, with its standard error: −1/2 for independent "
             "random lines. A curve that flattens has reached its systematic error, or that of the reference."},
            {"systematic",
             "The part of the relative RMS error that is the same for all seeds, estimated from the error of the "
             "mean over the seeds."}};
        for (const auto measures : {errorMeasures(), costMeasures()})
            for (const Measure& m : measures) definitions.push_back({m.name, m.meaning});
        page_.definitions(definitions);
    }

    const FormFactorPageInput& in_;
    const FormFactorComparison& of_;
    Progress& progress_;
    HtmlPage page_;
    PageFiles files_;
};

} // namespace

std::vector<FileContent> formFactorPage(const FormFactorPageInput& input, Progress& progress) {
    return PageBuilder(input, progress)();
}

} // namespace lambert
