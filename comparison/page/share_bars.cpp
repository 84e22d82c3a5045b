#include "comparison/page/share_bars.h"

#include "comparison/page/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

std::string shareBarsSvg(const std::vector<ShareBar>& bars, const std::string& description) {
    constexpr double kWidth = 600.0, kLabels = 110.0, kValues = 110.0, kRow = 34.0, kBar = 20.0;
    double lowest = 0.0;
    double highest = 0.01;
    for (const ShareBar& bar : bars) {
        lowest = std::min(lowest, bar.share - bar.error);
        highest = std::max(highest, bar.share + bar.error);
    }
    const double scale = (kWidth - kLabels - kValues) / (highest - lowest);
    const auto at = [&](double share) { return kLabels + scale * (share - lowest); };
    const double height = kRow * static_cast<double>(bars.size()) + 6.0;
    std::string svg = fmt::format(
        "<svg class=\"plot\" role=\"img\" aria-label=\"{}\" viewBox=\"0 0 {} {}\" style=\"max-width:720px\" "
        "xmlns=\"http://www.w3.org/2000/svg\">\n",
        htmlEscaped(description), kWidth, height);
    double middle = 0.5 * kRow + 3.0;
    for (const ShareBar& bar : bars) {
        const double left = at(std::min(0.0, bar.share));
        svg += fmt::format("<text x=\"0\" y=\"{:.1f}\" font-size=\"14\" fill=\"currentColor\">{}</text>\n",
                           middle + 5.0, htmlEscaped(bar.label));
        svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{}\" fill=\"{}\"/>\n", left,
                           middle - 0.5 * kBar, scale * std::abs(bar.share), kBar, bar.rest ? "#8a8f98" : "#2f7ed8");
        svg += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"currentColor\" stroke-width=\"2\"/>\n",
                           at(bar.share - bar.error), middle, at(bar.share + bar.error));
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"13\" fill=\"currentColor\">{}</text>\n",
                           at(std::max(0.0, bar.share + bar.error)) + 8.0, middle + 4.5,
                           fmt::format("{}{:.1f} ± {:.1f} %", bar.share < 0.0 ? "−" : "", 100.0 * std::abs(bar.share),
                                       100.0 * bar.error));
        middle += kRow;
    }
    return svg + fmt::format("<path d=\"M{0:.1f} 0V{1}\" stroke=\"currentColor\" stroke-opacity=\".5\"/>\n</svg>\n",
                             at(0.0), height);
}

} // namespace lambert
