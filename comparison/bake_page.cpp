#include "comparison/bake_page.h"

#include "baking/exposure.h"
#include "baking/reconstruction.h"
#include "comparison/bake_comparison_report.h"
#include "comparison/page/figure_text.h"
#include "comparison/page/html_page.h"
#include "comparison/page/page_files.h"
#include "comparison/page/scale_bar.h"
#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace lambert {

namespace {

constexpr int kDecades = 4; ///< of the scale at most

/// Values as shares of the mean of A, as scales show them; as they are where A is dark.
std::vector<float> relative(const std::vector<float>& values, const BakeComparison& comparison) {
    const double mean = comparison.overall.mean;
    std::vector<float> result;
    for (const float value : values)
        result.push_back(mean > 0.0 ? static_cast<float>(static_cast<double>(value) / mean) : value);
    return result;
}

class PageBuilder {
public:
    PageBuilder(const BakePageInput& input, Progress& progress)
        : in_(input),
          progress_(progress),
          scale_(relative(input.comparison.difference, input.comparison), kDecades),
          page_(in_.nameB + " against " + in_.nameA,
                fmt::format("{} of B, relative to A: {} RMS, {} on average",
                            in_.quantity == Quantity::Radiosity ? "Radiosity" : "Irradiance",
                            percentText(of().overall.relativeRms), signedPercent(of().overall))) {}

    std::vector<FileContent> operator()() {
        table();
        differences();
        light();
        facts();
        definitions();
        return files_.with(page_);
    }

private:
    const BakeComparison& of() const { return in_.comparison; }

    static std::string signedPercent(const FieldErrors& errors) {
        const double share = errors.energyRatio - 1.0;
        return (share > 0.0 ? "+" : share < 0.0 ? "−" : "") + percentText(std::abs(share));
    }

    void table() {
        page_.section("How far B is from A");
        HtmlTable table;
        table.head.emplace_back("channel");
        for (const FieldMeasure& m : fieldMeasures()) table.head.emplace_back(m.name);
        for (const NamedErrors& row : namedErrors(of())) {
            std::vector<HtmlCell> cells{std::string(row.name)};
            for (const FieldMeasure& m : fieldMeasures())
                cells.emplace_back(m.value == &FieldErrors::relativeRms ? percentText(row.errors.*m.value)
                                                                        : fmt::format("{:.5g}", row.errors.*m.value));
            table.rows.push_back(cells);
        }
        page_.table(table);
    }

    HtmlFigure difference(const std::string& name, const std::string& title, const std::vector<float>& values) {
        const Image image =
            patchPicture(in_.a.meshed.mesh, in_.rays, relative(values, of()), scale_, in_.camera, in_.size, progress_);
        return {title, files_.picture(name, image, title, &scale_), ""};
    }

    void differences() {
        page_.section("Where");
        page_.paragraph("The patches of A in the colour of the difference, mean of the channels, relative to the mean "
                        "of A, on one logarithmic scale.");
        std::vector<float> above, below;
        for (const float e : of().excess) {
            above.push_back(std::max(e, 0.0F));
            below.push_back(std::max(-e, 0.0F));
        }
        page_.figures({difference("difference", "|B − A|", of().difference),
                       difference("above", "where B is brighter", above),
                       difference("below", "where B is darker", below)},
                      3);
        page_.figures({{"", scaleBarSvg(scale_, "difference"), ""}}, 1);
    }

    HtmlFigure picture(const std::string& name, const std::string& title, const StoredSolution& solution,
                       const RayCaster& rays, std::optional<float>& exposure) {
        const BakedMesh baked = reconstructAverage(
            {solution.meshed.mesh, solution.meshed.optics, *solution.meshed.scene, solution.solution}, {});
        if (!exposure) exposure = automaticExposure(baked, in_.quantity);
        RenderOptions options{in_.size};
        options.quantity = in_.quantity;
        options.toneMapExposure = *exposure;
        Camera camera = in_.camera;
        if (in_.a.meshed.scene->origin != solution.meshed.scene->origin)
            camera.eye = placeInScene(*solution.meshed.scene, placeInFile(*in_.a.meshed.scene, camera.eye));
        const Image image = renderBaked(solution.meshed.mesh, baked, rays, camera, options, progress_);
        return {title, files_.picture(name, image, title), ""};
    }

    void light() {
        page_.section("The light");
        std::optional<float> exposure; // that of A for both
        std::vector<HtmlFigure> figures{picture("a", "A: " + in_.nameA, in_.a, in_.rays, exposure)};
        const RayCaster ofB(*in_.b.meshed.scene);
        figures.push_back(picture("b", "B: " + in_.nameB, in_.b, ofB, exposure));
        page_.figures(figures, 2);
    }

    static std::string origin(const StoredSolution& solution) {
        const PatchMesh& mesh = solution.meshed.mesh;
        return fmt::format("{}: {}, {}, {} patches, {:.4g} m²", solution.origin.scene, solution.origin.method,
                           solution.origin.solver, mesh.size(),
                           std::accumulate(mesh.area.begin(), mesh.area.end(), 0.0));
    }

    void facts() {
        page_.section("What was compared");
        HtmlTable table;
        table.add("A, the reference", origin(in_.a));
        table.add("B", origin(in_.b));
        table.add("Patches", of().samePatches
                                 ? "the same"
                                 : fmt::format("others: B at the centres of A's; {} of the area has no counterpart",
                                               percentText(of().unmatchedArea)));
        for (const auto& [name, value] : in_.facts) table.add(name, value);
        page_.table(table);
    }

    void definitions() {
        page_.section("What the figures mean");
        std::vector<HtmlPage::Definition> definitions;
        for (const FieldMeasure& m : fieldMeasures()) definitions.push_back({m.name, m.meaning});
        page_.definitions(definitions);
    }

    const BakePageInput& in_;
    Progress& progress_;
    ColourScale scale_;
    HtmlPage page_;
    PageFiles files_;
};

} // namespace

DifferencePicture differencePicture(const StoredSolution& reference, const BakeComparison& comparison,
                                    const RayCaster& rays, const Camera& camera, const PictureSize& size,
                                    Progress& progress) {
    const std::vector<float> values = relative(comparison.difference, comparison);
    const ColourScale scale(values, kDecades);
    return {patchPicture(reference.meshed.mesh, rays, values, scale, camera, size, progress), scale};
}

std::vector<FileContent> bakePage(const BakePageInput& input, Progress& progress) {
    return PageBuilder(input, progress)();
}

} // namespace lambert
