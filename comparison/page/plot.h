#pragma once

#include "core/progress.h"

#include <string>
#include <vector>

namespace lambert {

/// A curve with error bars on log-log axes.
struct PlotCurve {
    struct Point {
        double x = 0.0, y = 0.0;         //!< points that are not positive and finite are left out
        double lower = 0.0, upper = 0.0; //!< of the error bar in y
    };
    std::string label; //!< in the legend, UTF-8
    std::vector<Point> points;
    int style = 0; //!< colour and mark: a method has the same one in every plot
};

/// A horizontal line, such as the reference's own error.
struct PlotLevel {
    std::string label;
    double y = 0.0;
};

/// A logarithmic axis. `text` labels its round numbers.
struct PlotAxis {
    std::string label;
    std::string (*text)(double);
};

struct Plot {
    std::string name;        //!< letters, digits and underscores; unlike all others of a page
    std::string description; //!< for who cannot see it
    PlotAxis x, y;
    std::vector<PlotCurve> curves;
    std::vector<PlotLevel> levels;
    int width = 600; //!< in units of the SVG; the height follows from the legend
};

/// A plot, and what a page says of it.
struct CaptionedPlot {
    std::string title;
    Plot plot;
    std::string caption;
};

/// The plot, which has at least one point to be drawn, as an `<svg>` element for a page: transparent, texts and axes in the colour of the text around it, all ids
/// beginning with the plot's name. Throws as runGnuplot.
std::string plotSvg(const Plot& plot, const Progress& progress);

} // namespace lambert
