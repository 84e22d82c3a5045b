#include "comparison/plot.h"

#include "comparison/gnuplot.h"
#include "comparison/html.h"
#include "core/error.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace lambert {

namespace {

/// gnuplot's string in double quotes: for a label of any characters.
std::string quoted(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return result + '"';
}

void replaceAll(std::string& text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

/// The `<svg>` element alone, see plotSvg.
std::string embedded(std::string svg, const Plot& plot) {
    const std::size_t begin = svg.find("<svg");
    const std::size_t end = svg.find("<g id=\"gnuplot_canvas\"");
    if (begin == std::string::npos || end == std::string::npos || svg.find("</svg>") == std::string::npos)
        throw SystemError("gnuplot: did not write an SVG");
    std::string head =
        fmt::format("<svg class=\"plot\" role=\"img\" aria-label=\"{}\" viewBox=\"0 0 {} {}\" "
                    "xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\">\n",
                    htmlEscaped(plot.description), plot.width, plot.height);
    svg = head + svg.substr(end);
    for (const char* quote : {"'", "\""}) {
        for (const char* attribute : {"fill", "stroke", "color"})
            replaceAll(svg, fmt::format("{}={}black{}", attribute, quote, quote),
                       fmt::format("{}={}currentColor{}", attribute, quote, quote));
        for (const char* id : {"gp", "textbox", "greybox"}) {
            replaceAll(svg, fmt::format("id={}{}", quote, id), fmt::format("id={}{}_{}", quote, plot.name, id));
            replaceAll(svg, fmt::format("href={}#{}", quote, id), fmt::format("href={}#{}_{}", quote, plot.name, id));
        }
    }
    replaceAll(svg, "gnuplot_canvas", plot.name + "_canvas");
    return svg;
}

/// Marks of gnuplot's SVG terminal that are told apart even without colour: disc, square, triangle, diamond, …
constexpr std::array kMarks{7, 5, 9, 13, 11, 6, 4};

std::string dataBlocks(const Plot& plot) {
    std::string text;
    for (std::size_t k = 0; k < plot.curves.size(); ++k) {
        text += fmt::format("$curve{} << EOD\n", k);
        for (const PlotCurve::Point& p : plot.curves[k].points) {
            // A bar that would reach below 0 ends within the plot's decade.
            const double lower = p.lower > 0.0 ? p.lower : 0.1 * p.y;
            if (p.x > 0.0 && p.y > 0.0) text += fmt::format("{:.9g} {:.9g} {:.9g} {:.9g}\n", p.x, p.y, lower, p.upper);
        }
        text += "EOD\n";
    }
    return text;
}

} // namespace

std::string plotColour(int style) {
    constexpr std::array kColours{"#2f7ed8", "#e07b1a", "#169f78", "#c8509b", "#8f7a10", "#7a6ad8", "#d04545"};
    return kColours[static_cast<std::size_t>(style) % kColours.size()];
}

std::string plotSvg(const Plot& plot, const Progress& progress) {
    std::string script = fmt::format(
        "set terminal svg size {},{} dynamic enhanced font \"sans-serif,13\" linewidth 1.3 name {}\n"
        "set encoding utf8\nset logscale xy\nset format \"10^{{%T}}\"\nset grid lt 1 lc rgb \"gray\" lw 0.4\n"
        "set border 3\nset tics nomirror out scale 0.8\nset mxtics 10\nset mytics 10\n"
        "set key bottom left Left reverse noenhanced samplen 2 spacing 1.15 width 1\n"
        "set bars 0.6\nset offsets 0, 0, 0, 0\nset lmargin 9\n",
        plot.width, plot.height, quoted(plot.name));
    script += fmt::format("set xlabel {} noenhanced\nset ylabel {} noenhanced offset 0.5,0\n", quoted(plot.xLabel),
                          quoted(plot.yLabel));
    script += dataBlocks(plot);
    std::vector<std::string> parts;
    for (std::size_t k = 0; k < plot.curves.size(); ++k) {
        const PlotCurve& curve = plot.curves[k];
        const std::string look = fmt::format("lc rgb {} lw 1.4", quoted(plotColour(curve.style)));
        parts.push_back(fmt::format("$curve{0} using 1:2:3:4 with yerrorbars {1} pt 0 notitle", k, look));
        parts.push_back(fmt::format("$curve{} using 1:2 with linespoints {} pt {} ps 0.7 title {}", k, look,
                                    kMarks[static_cast<std::size_t>(curve.style) % kMarks.size()],
                                    quoted(curve.label)));
    }
    for (const PlotLevel& level : plot.levels)
        parts.push_back(
            fmt::format("{:.9g} with lines dt 2 lw 1 lc rgb \"gray50\" title {}", level.y, quoted(level.label)));
    script += fmt::format("plot {}\n", fmt::join(parts, ", \\\n     "));
    return embedded(runGnuplot(script, progress), plot);
}

} // namespace lambert
