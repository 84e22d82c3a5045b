#include "comparison/vpl_page.h"

#include "comparison/page/figure_text.h"
#include "comparison/page/html_page.h"
#include "comparison/page/page_files.h"
#include "comparison/page/scale_bar.h"
#include "comparison/page/share_bars.h"
#include "comparison/patch_picture.h"
#include "comparison/vpl_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace lambert {

namespace {

constexpr int kMostDecades = 3; ///< of a false-colour scale
constexpr std::array kErrorSizes{&FieldErrors::bias, &FieldErrors::meanAbsolute, &FieldErrors::rms,
                                 &FieldErrors::percentile99, &FieldErrors::maximum};

Image falseColours(const Image& like, std::span<const float> values, const ColourScale& scale) {
    Image image = like;
    for (std::size_t i = 0; i < values.size(); ++i) image.pixels[i] = linearDisplay(scale.colour(values[i]));
    image.content = PixelContent::Display;
    return image;
}

/// Signed: method − reference.
Image differenceOf(const Image& light, const Image& reference) {
    Image image = light;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] -= reference.pixels[i];
    return image;
}

class PageBuilder {
public:
    PageBuilder(const VplPageInput& input, Progress& progress)
        : in_(input),
          of_(input.comparison),
          mean_(input.comparison.meanIrradiance()),
          progress_(progress),
          page_("Virtual point lights in " + input.scene, subtitle()) {}

    std::vector<FileContent> operator()() {
        reference_ = files_.picture("reference", shown(in_.pictures.reference), "reference");
        files_.radiance("reference", in_.pictures.reference);
        page_.figureAndTable(
            {"", reference_, "The scene in the light of the reference, tone-mapped as all pictures here."}, facts());
        summary();
        for (std::size_t m = 0; m < of_.methods.size(); ++m) {
            anatomy(of_.methods[m]);
            pictures(of_.methods[m], in_.pictures.methods[m]);
            partMaps(of_.methods[m]);
        }
        plots();
        details();
        reading();
        return files_.with(page_);
    }

private:
    std::string subtitle() const {
        std::vector<std::string> names;
        for (const VplMethodResult& method : in_.comparison.methods) names.push_back(method.method->name());
        return fmt::format("{} against patch radiosity, at {} points and in one picture", fmt::join(names, ", "),
                           in_.comparison.points.receivers.size());
    }

    Image shown(const Image& radiance) const { return toneMapped(radiance, in_.pictures.exposure); }

    HtmlTable facts() const {
        const ReferenceLight& reference = of_.reference;
        HtmlTable table;
        table.add("Scene", in_.scene);
        table.add("Receivers", fmt::format("the centres of {} patches, weighted by area; {} × {} pixels",
                                           of_.points.receivers.size(), in_.pictures.reference.width,
                                           in_.pictures.reference.height));
        table.add("Mean irradiance", fmt::format("{:.4g} per m²; errors are shares of it", mean_));
        table.add("Reference", fmt::format("patch radiosity on {} patches, {} lines each, gathered at the points and "
                                           "extrapolated with the error ~ h^{:.2f} ({})",
                                           fmt::join(of_.referencePatches, ", "), of_.referenceLines, reference.order,
                                           reference.orderFound ? "found" : "assumed"));
        table.add("Its own error",
                  fmt::format("{}: meshes {}, form factors {}, gathering {}. Errors below it tell nothing",
                              percentText(reference.rms.total() / mean_), percentText(reference.rms.mesh / mean_),
                              percentText(reference.rms.transport / mean_),
                              percentText(reference.rms.gathering / mean_)));
        table.add("In the picture", percentText(in_.pictures.ownError) + " of the mean radiance");
        for (const VplMethodResult& method : of_.methods)
            for (const auto& [name, value] : method.method->options())
                table.add(of_.methods.size() > 1 ? fmt::format("{}, {}", method.method->name(), name)
                                                 : capitalised(name),
                          value);
        for (const auto& [name, value] : in_.facts) table.add(name, value);
        return table;
    }

    static std::string capitalised(std::string text) {
        text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
        return text;
    }

    static MeanDeviation overall(const VplRung& rung, double FieldErrors::*value, double unit) {
        return rung.of([&](const VplRun& run) { return run.errors.overall.*value / unit; });
    }

    static std::string significance(bool significant) { return significant ? "" : "not significant"; }

    void summary() {
        page_.section("How far off");
        HtmlTable table;
        table.dense = true;
        table.caption =
            fmt::format("Relative to the reference's mean: irradiance at the patches' centres, mean and deviation over "
                        "{} seeds; radiance in the picture, first seed.",
                        of_.methods.empty() ? 0 : of_.methods.front().ladder.front().runs.size());
        table.head = {"method", "vpls",    "lights",       "where",    "bias", "mean abs", "RMS",
                      "99 %",   "largest", "energy ratio", "PSNR, dB", "FLIP", "seconds",  ""};
        for (std::size_t m = 0; m < of_.methods.size(); ++m) {
            const VplMethodResult& method = of_.methods[m];
            const VplRung& main = method.ladder[method.main];
            std::vector<HtmlCell> row{method.method->name(), countText(main.effort),
                                      countText(main.of(&VplRun::lights).mean), std::string("points")};
            for (const auto value : kErrorSizes) row.emplace_back(percentText(overall(main, value, mean_)));
            row.emplace_back(fmt::format("{:.4f}", overall(main, &FieldErrors::energyRatio, 1.0).mean));
            row.insert(row.end(), {HtmlCell("–"), HtmlCell("–")});
            row.emplace_back(fmt::format("{:.3g}", main.of(&VplRun::wallSeconds).mean));
            row.emplace_back(significance(method.significant));
            table.rows.push_back(row);
            const ComparedPicture& picture = in_.pictures.methods[m];
            const FieldErrors& errors = picture.errors.overall;
            const double unit = errors.mean;
            row = {method.method->name(), countText(main.effort), HtmlCell(), std::string("picture")};
            for (const auto value : kErrorSizes) row.emplace_back(percentText(errors.*value / unit));
            row.emplace_back(fmt::format("{:.4f}", errors.energyRatio));
            row.emplace_back(fmt::format("{:.1f}", picture.psnr));
            row.emplace_back(fmt::format("{:.4f}", picture.flip));
            row.emplace_back(fmt::format("{:.3g}", picture.seconds));
            row.emplace_back(significance(errors.relativeRms > in_.pictures.ownError));
            table.rows.push_back(row);
        }
        page_.table(table);
    }

    void anatomy(const VplMethodResult& method) {
        const ErrorAnatomy& anatomy = method.anatomy;
        page_.section("Why: the anatomy of " + method.method->name());
        page_.paragraph(fmt::format(
            "Each approximation is exchanged for the exact one, from the top down; what the light changes by is that "
            "approximation's part of the error. Shares are of the squared error at {} particles, whose root is {} of "
            "the mean "
            "irradiance, and add up to 100 %.",
            countText(method.ladder[method.main].effort),
            percentText(MeanDeviation{anatomy.rms / mean_, anatomy.rmsError / mean_})));
        std::vector<ShareBar> bars;
        HtmlTable table;
        table.dense = true;
        table.words = 2;
        table.head = {"part", "share", "its own RMS", "its bias", "error without it", "is", "exchanged for"};
        for (const ErrorPart& part : anatomy.parts) {
            bars.push_back({part.approximation.part, part.share, part.shareError});
            table.rows.push_back(
                {part.approximation.part, percentText(MeanDeviation{part.share, part.shareError}),
                 percentText(part.rms / mean_), percentText(MeanDeviation{part.bias / mean_, part.biasError / mean_}),
                 percentText(part.rmsWithout / mean_), part.approximation.used, part.approximation.instead});
        }
        bars.back().rest = true;
        const std::string svg =
            files_.drawing("anatomy_" + method.method->name(), shareBarsSvg(bars, "shares of the squared error"));
        page_.figures({{"Share of the squared error", svg,
                        "Thin lines: one standard error over the seeds; of what is left also the most that the error "
                        "of the reference can add."}},
                      1);
        page_.table(table);
        if (!method.bounces.empty()) bounces(method);
    }

    void bounces(const VplMethodResult& method) {
        HtmlTable table;
        table.dense = true;
        table.caption = fmt::format(
            "By bounce: light that was reflected so many times on its way, mean and deviation over {} seeds, relative "
            "to the mean of all light; the energy ratio by itself.",
            method.bounces.front().runs.size());
        table.head = {"reflected", "light",   "bias",         "mean abs",          "RMS",
                      "99 %",      "largest", "energy ratio", "reference's error", ""};
        for (std::size_t k = 0; k < method.bounces.size(); ++k) {
            const VplBounce& bounce = method.bounces[k];
            std::vector<HtmlCell> row{k == 1 ? std::string("once") : fmt::format("{} times", k),
                                      percentText(bounce.of(&FieldErrors::mean).mean / mean_)};
            for (const auto value : kErrorSizes) {
                const MeanDeviation found = bounce.of(value);
                row.emplace_back(percentText(MeanDeviation{found.mean / mean_, found.deviation / mean_}));
            }
            row.emplace_back(fmt::format("{:.4f}", bounce.of(&FieldErrors::energyRatio).mean));
            row.emplace_back(percentText(of_.referenceBounces[k].rms.total() / mean_));
            row.emplace_back(significance(bounce.significant));
            table.rows.push_back(row);
        }
        page_.table(table);
    }

    void pictures(const VplMethodResult& method, const ComparedPicture& picture) {
        const std::string name = method.method->name();
        page_.section("Where: " + name + " in the picture");
        const std::string shownMethod = files_.picture(name, shown(picture.light), name);
        files_.radiance(name, picture.light);
        files_.radiance("difference_" + name, differenceOf(picture.light, in_.pictures.reference));
        page_.slider({"reference", reference_, ""}, {name, shownMethod, ""},
                     "Left of the line the reference, right of it the method.");
        const ColourScale errors(picture.relativeError, kMostDecades);
        const ColourScale seen(picture.flipMap, kMostDecades);
        const std::string error = "error_" + name;
        const std::string flip = "flip_" + name;
        page_.figures(
            {{"Error of the radiance",
              files_.picture(error, falseColours(picture.light, picture.relativeError, errors), "error of " + name,
                             &errors) +
                  scaleBarSvg(errors, error),
              "|L − L_ref|, mean of the channels, relative to the mean radiance."},
             {"What the eye sees of it",
              files_.picture(flip, falseColours(picture.light, picture.flipMap, seen), "FLIP of " + name, &seen) +
                  scaleBarSvg(seen, flip),
              "FLIP of the tone-mapped pictures, 0 to 100 %."}},
            2);
    }

    void partMaps(const VplMethodResult& method) {
        std::vector<std::vector<float>> maps;
        std::vector<float> all;
        for (const std::vector<float>& sizes : method.partSizes) {
            std::vector<float>& map = maps.emplace_back(in_.meshed.mesh.size(), 0.0F);
            for (std::size_t i = 0; i < sizes.size(); ++i) map[of_.patches[i]] = sizes[i] / static_cast<float>(mean_);
            all.insert(all.end(), map.begin(), map.end());
        }
        const ColourScale scale(all, kMostDecades);
        page_.section("Where each part is");
        page_.paragraph("The size of each part at the patches' centres, relative to the mean irradiance, one scale for "
                        "all; of sampling the "
                        "deviation of a single run. Means over the seeds have noise of their own.");
        std::vector<HtmlFigure> figures;
        for (std::size_t k = 0; k < maps.size(); ++k) {
            const std::string& part = method.anatomy.parts[k].approximation.part;
            const Image image =
                patchPicture(in_.meshed.mesh, *in_.meshed.rays, maps[k], scale, in_.pictures.camera,
                             {in_.pictures.reference.width, in_.pictures.reference.height, 2}, progress_);
            figures.push_back({part,
                               files_.picture("part_" + method.method->name() + "_" + part, image,
                                              part + " of " + method.method->name(), &scale),
                               ""});
        }
        page_.figures(figures, 3);
        page_.figures({{"", scaleBarSvg(scale, "part_" + method.method->name()), ""}}, 1);
    }

    void plots() {
        page_.section("Error against cost");
        std::vector<HtmlFigure> figures;
        for (const CaptionedPlot& p : vplPlots(of_))
            figures.push_back({p.title, files_.plot(p.plot, progress_), p.caption});
        page_.figures(figures, 2);
    }

    void details() {
        page_.section("All figures");
        HtmlTable table;
        table.dense = true;
        table.caption =
            "Means over the seeds, at the patches' centres. results.csv has every run, results.json the deviations.";
        table.head = {"method",   "vpls", "lights", "rays", "CPU s",   "wall s",      "bias",
                      "mean abs", "RMS",  "noise",  "99 %", "largest", "energy ratio"};
        for (const VplMethodResult& method : of_.methods) {
            for (const VplRung& rung : method.ladder) {
                std::vector<HtmlCell> row{method.method->name(), countText(rung.effort),
                                          countText(rung.of(&VplRun::lights).mean),
                                          countText(rung.of(&VplRun::rays).mean)};
                for (const auto seconds : {&VplRun::processorSeconds, &VplRun::wallSeconds})
                    row.emplace_back(fmt::format("{:.3g}", rung.of(seconds).mean));
                for (const auto value : {&FieldErrors::bias, &FieldErrors::meanAbsolute, &FieldErrors::rms})
                    row.emplace_back(percentText(overall(rung, value, mean_).mean));
                row.emplace_back(percentText(rung.sampling / mean_));
                for (const auto value : {&FieldErrors::percentile99, &FieldErrors::maximum})
                    row.emplace_back(percentText(overall(rung, value, mean_).mean));
                row.emplace_back(fmt::format("{:.4f}", overall(rung, &FieldErrors::energyRatio, 1.0).mean));
                table.rows.push_back(row);
            }
            if (&method != &of_.methods.back()) table.rows.emplace_back();
        }
        page_.table(table);
    }

    void reading() {
        page_.section("What the figures mean");
        page_.definitions(
            {{"bias, mean abs, RMS", "Mean of the error, of its size, and root of the mean of its square, over points "
                                     "(weighted by area) and the three channels, relative to the reference's mean."},
             {"99 %, largest", "The size of the error that 99 % of the area does not exceed; the largest one."},
             {"energy ratio", "The light that arrives over that of the reference."},
             {"noise", "RMS of what other random numbers would change: the part that more lights take away."},
             {"not significant", "The RMS error is below the reference's own: it may be the reference that errs."},
             {"share",
              "Of the squared error: the inner product of error and part over the square of the error. A part that "
              "cancels others has a negative share."},
             {"error without it", "The RMS error that would be left if this part alone were taken away."},
             {"unexplained", "What is left when all is exchanged: the error of the reference, and what no exchange "
                             "names."},
             {"PSNR, FLIP",
              "Of the tone-mapped pictures: peak signal to noise of the encoded colours; FLIP (Andersson et al. "
              "2020) for a screen of 67 pixels per degree, 0 alike to 1."}});
    }

    const VplPageInput& in_;
    const VplComparison& of_;
    double mean_;
    Progress& progress_;
    HtmlPage page_;
    PageFiles files_;
    std::string reference_;
};

} // namespace

std::vector<FileContent> vplPage(const VplPageInput& input, Progress& progress) {
    return PageBuilder(input, progress)();
}

} // namespace lambert
