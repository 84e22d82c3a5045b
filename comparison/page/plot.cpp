#include "comparison/page/plot.h"

#include "comparison/page/colour_scale.h"
#include "comparison/page/gnuplot.h"
#include "comparison/page/html.h"
#include "core/error.h"

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace lambert {

namespace {

/// gnuplot's string in double quotes: for a label of any characters.
std::string gnuplotString(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return result + '"';
}

/// The `<svg>` element alone, see plotSvg.
std::string embedded(std::string svg, const Plot& plot, int height) {
    using boost::replace_all;
    const std::size_t begin = svg.find("<svg");
    const std::size_t end = svg.find("<g id=\"gnuplot_canvas\"");
    if (begin == std::string::npos || end == std::string::npos || svg.find("</svg>") == std::string::npos)
        throw SystemError("gnuplot: did not write an SVG");
    std::string head =
        fmt::format("<svg class=\"plot\" role=\"img\" aria-label=\"{}\" viewBox=\"0 0 {} {}\" "
                    "xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\">\n",
                    htmlEscaped(plot.description), plot.width, height);
    svg = head + svg.substr(end);
    for (const char* quote : {"'", "\""}) {
        for (const char* attribute : {"fill", "stroke", "color"})
            replace_all(svg, fmt::format("{}={}black{}", attribute, quote, quote),
                        fmt::format("{}={}currentColor{}", attribute, quote, quote));
        for (const char* id : {"gp", "textbox", "greybox"}) {
            replace_all(svg, fmt::format("id={}{}", quote, id), fmt::format("id={}{}_{}", quote, plot.name, id));
            replace_all(svg, fmt::format("href={}#{}", quote, id), fmt::format("href={}#{}_{}", quote, plot.name, id));
        }
    }
    replace_all(svg, "gnuplot_canvas", plot.name + "_canvas");
    return svg;
}

constexpr int kHeight = 360, kLegendLine = 20; ///< of a plot in units of the SVG, without and for a line of its legend

/// Marks of gnuplot's SVG terminal that are told apart even without colour: disc, square, triangle, diamond, …
constexpr std::array kMarks{7, 5, 9, 13, 11, 6, 4};

/// What is drawn on an axis.
struct Range {
    double lowest = INFINITY, highest = 0.0;
    void add(double value) {
        if (!(value > 0.0) || !std::isfinite(value)) return;
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
    }
};

bool isDrawn(const PlotCurve::Point& p) { return p.x > 0.0 && p.y > 0.0 && std::isfinite(p.x) && std::isfinite(p.y); }

/// The curves' points; and what the axes have to hold.
std::string dataBlocks(const Plot& plot, Range& x, Range& y) {
    std::string text;
    for (std::size_t k = 0; k < plot.curves.size(); ++k) {
        text += fmt::format("$curve{} << EOD\n", k);
        for (const PlotCurve::Point& p : plot.curves[k].points) {
            if (!isDrawn(p)) continue;
            const double lower = std::max(p.lower, 0.1 * p.y); // a bar may reach below 0, which no axis holds
            x.add(p.x);
            for (const double value : {lower, p.y, p.upper}) y.add(value);
            text += fmt::format("{:.9g} {:.9g} {:.9g} {:.9g}\n", p.x, p.y, lower, p.upper);
        }
        text += "EOD\n";
    }
    for (const PlotLevel& level : plot.levels)
        if (level.y > 0.1 * y.lowest) y.add(level.y);
    return text;
}

/// The axis a little longer than what is drawn, with labels at decades, or on a short one at 2 and 5 as well.
std::string axisScript(char axis, const PlotAxis& of, const Range& range) {
    const double margin = std::max(1.15, std::pow(range.highest / range.lowest, 0.04));
    const double lowest = range.lowest / margin;
    const double highest = range.highest * margin;
    const double decades = std::log10(highest / lowest);
    std::vector<std::string> ticks;
    for (int n = stepBelow(lowest); roundStep(n) <= highest; ++n) {
        if (roundStep(n) < lowest) continue;
        const bool labelled = n % 3 == 0 ? decades < 7.0 || n % 6 == 0 : decades < 1.7;
        if (labelled || decades < 4.0)
            ticks.push_back(
                fmt::format("{} {:.9g} {}",
                            gnuplotString(labelled ? boost::replace_all_copy(of.text(roundStep(n)), "%", "%%") : ""),
                            roundStep(n), labelled ? 0 : 1));
    }
    return fmt::format("set {0}range [{1:.9g}:{2:.9g}]\nset {0}tics ({3})\nset {0}label {4} noenhanced\n", axis, lowest,
                       highest, fmt::join(ticks, ", "), gnuplotString(of.label));
}

/// The colour of a style: told apart by the colour-blind, on white and on black.
std::string plotColour(int style) {
    constexpr std::array kColours{"#2f7ed8", "#e07b1a", "#169f78", "#c8509b", "#8f7a10", "#7a6ad8", "#d04545"};
    return kColours[static_cast<std::size_t>(style) % kColours.size()];
}

} // namespace

std::string plotSvg(const Plot& plot, const Progress& progress) {
    const auto legend = static_cast<int>(plot.curves.size() + plot.levels.size());
    const int height = kHeight + kLegendLine * legend;
    Range x, y;
    const std::string data = dataBlocks(plot, x, y);
    std::string script =
        fmt::format("set terminal svg size {},{} dynamic enhanced font \"sans-serif,13\" linewidth 1.3 name {}\n"
                    "set encoding utf8\nset logscale xy\nset grid lt 1 lc rgb \"gray\" lw 0.35\n"
                    "set border 3 lw 0.8\nset tics nomirror out scale 0.7,0.4\n"
                    "set key tmargin left vertical maxcols 1 Left reverse noenhanced samplen 2 spacing 1.2\n",
                    plot.width, height, gnuplotString(plot.name));
    script += axisScript('x', plot.x, x) + axisScript('y', plot.y, y) + data;
    std::vector<std::string> parts;
    for (std::size_t k = 0; k < plot.curves.size(); ++k) {
        const PlotCurve& curve = plot.curves[k];
        const std::string look = fmt::format("lc rgb {} lw 1.4", gnuplotString(plotColour(curve.style)));
        parts.push_back(fmt::format("$curve{0} using 1:3:(0):($4-$3) with vectors nohead {1} notitle", k, look));
        parts.push_back(fmt::format("$curve{} using 1:2 with linespoints {} pt {} ps 0.7 title {}", k, look,
                                    kMarks[static_cast<std::size_t>(curve.style) % kMarks.size()],
                                    gnuplotString(curve.label)));
    }
    for (const PlotLevel& level : plot.levels)
        parts.push_back(
            fmt::format("{:.9g} with lines dt 2 lw 1 lc rgb \"gray50\" title {}", level.y, gnuplotString(level.label)));
    script += fmt::format("plot {}\n", fmt::join(parts, ", \\\n     "));
    return embedded(runGnuplot(script, progress), plot, height);
}

} // namespace lambert
