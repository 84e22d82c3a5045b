#include "comparison/page/colour_scale.h"
#include "comparison/page/figure_text.h"
#include "comparison/page/gnuplot.h"
#include "comparison/page/html.h"
#include "comparison/page/html_page.h"
#include "comparison/page/plot.h"
#include "comparison/page/scale_bar.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>

namespace lambert {
namespace {

TEST(Html, NamesAreEscaped) {
    EXPECT_EQ(htmlEscaped("<script>\"a\" & 'b'</script>"),
              "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;&lt;/script&gt;");
    EXPECT_EQ(htmlEscaped("Küche — 漢字 😀"), "Küche — 漢字 😀");
}

TEST(Html, WhatIsNotTextIsReplaced) {
    EXPECT_EQ(htmlEscaped("a\x01z"), "a\xEF\xBF\xBDz");
    EXPECT_EQ(htmlEscaped("caf\xE9"), "caf\xEF\xBF\xBD");                   // Latin-1
    EXPECT_EQ(htmlEscaped("\xC0\xBC"), "\xEF\xBF\xBD\xEF\xBF\xBD");         // < in two bytes
    EXPECT_EQ(htmlEscaped("\xED\xA0\x80").find("\xED"), std::string::npos); // a surrogate
    EXPECT_EQ(htmlEscaped("\xE6\xBC"), "\xEF\xBF\xBD\xEF\xBF\xBD");         // ends early
}

TEST(HtmlPage, EveryPartEscapesItsTexts) {
    const std::string bad = "<x>&";
    HtmlPage page(bad, bad);
    page.section(bad);
    page.paragraph(bad);
    HtmlTable table;
    table.caption = bad;
    table.head = {bad, bad};
    table.rows = {{bad, bad}, {}};
    page.table(table);
    page.figures({{bad, htmlPng("", 1, 1, bad), bad}}, 1);
    page.figureAndTable({bad, "<svg></svg>", bad}, table);
    page.definitions({{bad, bad}});
    EXPECT_EQ(page.text().find("<x>"), std::string::npos);
    EXPECT_EQ(page.text().find("&<"), std::string::npos);
}

/// Relative luminance of an encoded sRGB colour (IEC 61966-2-1), and the lightness L* of CIE 1976.
double lightness(const Rgb& encoded) {
    const Rgb c = linearDisplay(encoded);
    const double y =
        0.2126 * static_cast<double>(c.x) + 0.7152 * static_cast<double>(c.y) + 0.0722 * static_cast<double>(c.z);
    return y > 0.008856 ? 116.0 * std::cbrt(y) - 16.0 : 903.3 * y;
}

TEST(ColourScale, LightnessRisesEvenly) {
    // The map goes from L* = 14.8 to 90.9; it is kept as 20 colours of 8 bits.
    constexpr int kSteps = 19;
    const double even = (lightness(viridis(1.0F)) - lightness(viridis(0.0F))) / kSteps;
    EXPECT_NEAR(even * kSteps, 76.1, 0.5);
    for (int k = 0; k < kSteps; ++k) {
        const double step =
            lightness(viridis(static_cast<float>(k + 1) / kSteps)) - lightness(viridis(static_cast<float>(k) / kSteps));
        EXPECT_NEAR(step, even, 0.25 * even) << k;
    }
}

TEST(ColourScale, RoundStepsAreOneTwoFive) {
    const std::array expected{0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0};
    for (int n = -4; n <= 4; ++n) EXPECT_NEAR(roundStep(n), expected[static_cast<std::size_t>(n + 4)], 1e-15);
    for (int n = -30; n <= 30; ++n) {
        EXPECT_EQ(stepBelow(roundStep(n) * 1.001), n);
        EXPECT_EQ(stepBelow(roundStep(n) * 0.999), n - 1);
    }
}

TEST(ColourScale, HoldsTheValuesBetweenRoundNumbers) {
    const std::array values{0.0F, 0.003F, 0.03F, 0.004F, INFINITY};
    const ColourScale scale(values, 3);
    EXPECT_NEAR(scale.lowest(), 0.002, 1e-12);
    EXPECT_NEAR(scale.highest(), 0.05, 1e-12);
    EXPECT_EQ(scale.position(0.0), 0.0F);
    EXPECT_EQ(scale.position(1.0), 1.0F);
    EXPECT_NEAR(static_cast<double>(scale.position(0.01)), 0.5, 1e-6); // the geometric mean of the ends
    EXPECT_EQ(scale.ticks().front(), scale.lowest());
    EXPECT_EQ(scale.ticks().back(), scale.highest());

    const ColourScale wide(std::array{1e-9F, 1.5F}, 3);
    EXPECT_NEAR(wide.highest() / wide.lowest(), 1000.0, 1e-6);
    const ColourScale none(std::array{0.0F}, 3);
    EXPECT_LT(none.lowest(), none.highest());
}

TEST(ScaleBar, BarOfAPictureHasTheScalesColours) {
    Image picture;
    picture.width = 200;
    picture.height = 50;
    picture.pixels.assign(200 * 50, Rgb(0.5F));
    const ColourScale scale(std::array{0.01F, 0.09F}, 3);
    const Image image = withScaleBar(picture, scale);
    EXPECT_GT(image.height, picture.height);
    EXPECT_EQ(image.at(10, 10), Rgb(0.5F));
    const Rgb left = image.at(26, 60);
    const Rgb right = image.at(174, 60);
    EXPECT_LT(lightness(viridis(0.02F)), lightness(viridis(0.98F)));
    EXPECT_LT(left.y, right.y);
    EXPECT_GT(right.y, 0.7F); // yellow
}

TEST(FigureText, ThreeDigitsAndUnits) {
    EXPECT_EQ(percentText(0.123456), "12.3 %");
    EXPECT_EQ(percentText(0.00012345), "0.0123 %");
    EXPECT_EQ(percentText(12.3), "1230 %");
    EXPECT_EQ(percentText(-0.0123), "−1.23 %");
    EXPECT_EQ(percentText(0.0), "0");
    EXPECT_EQ(percentText(MeanDeviation{0.238, 0.002}), "23.8 ± 0.2 %");
    EXPECT_EQ(percentText(MeanDeviation{0.1418, 0.0002}), "14.18 ± 0.02 %");
    EXPECT_EQ(percentText(MeanDeviation{0.000966, 0.040074}), "0.10 ± 4.01 %");
    EXPECT_EQ(percentText(2e-7), "< 0.0001 %");
    EXPECT_EQ(countText(999.0), "999");
    EXPECT_EQ(countText(1234567.0), "1.23 M");
    EXPECT_EQ(numberLabel(0.2), "0.2");
    EXPECT_EQ(numberLabel(2e-6), "2·10^{−6}");
    EXPECT_EQ(numberLabel(1e-6), "10^{−6}");
    EXPECT_EQ(slopeText(PowerLaw{-0.5, 1.0, 0.01}), "−0.50 ± 0.01");
}

/// Plots need gnuplot, which the program asks for.
class Gnuplot : public testing::Test {
protected:
    Progress progress_;
};

Plot smallPlot() {
    Plot plot;
    plot.name = "small";
    plot.description = "a \"plot\" & <more>";
    plot.x = {"rays", countText};
    plot.y = {"error", percentLabel};
    plot.curves = {
        {"one & \"two\" <three>", {{1e3, 0.1, 0.09, 0.11}, {1e5, 0.01, -0.001, 0.02}, {1e6, 0.0, 0.0, 0.0}}, 0}};
    plot.levels = {{"level", 0.005}};
    return plot;
}

TEST_F(Gnuplot, PlotIsOneElementWithIdsOfItsOwn) {
    const std::string svg = plotSvg(smallPlot(), progress_);
    EXPECT_TRUE(svg.starts_with("<svg"));
    EXPECT_EQ(svg.substr(svg.find_last_not_of(" \n") - 5, 6), "</svg>");
    for (const char* wanted :
         {"one &amp; \"two\" &lt;three>", "a &quot;plot&quot; &amp; &lt;more&gt;", "10 k", "1 %", "level"})
        EXPECT_NE(svg.find(wanted), std::string::npos) << wanted;
    for (const char* attribute : {"id=\"", "id='"})
        for (std::size_t at = svg.find(attribute); at != std::string::npos; at = svg.find(attribute, at + 1))
            EXPECT_EQ(svg.compare(at + 4, 6, "small_"), 0) << svg.substr(at, 40);
    EXPECT_EQ(svg.find("=\"black\""), std::string::npos);
    EXPECT_EQ(svg.find("='black'"), std::string::npos);
}

TEST_F(Gnuplot, ABadScriptIsAnErrorThatSaysWhy) {
    try {
        runGnuplot("set nonsense\n", progress_);
        FAIL();
    } catch (const SystemError& error) {
        EXPECT_NE(std::string(error.what()).find("gnuplot: "), std::string::npos) << error.what();
    }
}

TEST_F(Gnuplot, MegabytesGoBothWays) {
    std::string script = "set terminal svg\n$data << EOD\n";
    for (int k = 1; k < 50'000; ++k) script += std::to_string(k) + " " + std::to_string(k % 97) + "\n";
    EXPECT_GT(runGnuplot(script + "EOD\nplot $data with points\n", progress_).size(), 1'000'000U);
}

TEST_F(Gnuplot, CancellingEndsIt) {
    progress_.cancel();
    EXPECT_THROW(runGnuplot("pause 60\n", progress_), Cancelled);
}

TEST_F(Gnuplot, WithoutItTheErrorNamesThePackage) {
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", "/nonexistent", 1);
    std::string message;
    try {
        requireGnuplot();
    } catch (const SystemError& error) {
        message = error.what();
    }
    ::setenv("PATH", path.c_str(), 1);
    EXPECT_NE(message.find("gnuplot-nox"), std::string::npos);
}

} // namespace
} // namespace lambert
