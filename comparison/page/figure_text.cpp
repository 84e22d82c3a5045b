#include "comparison/page/figure_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

/// Decimals of three significant digits.
int decimals(double percent) {
    const double size = std::abs(percent);
    return size >= 99.95 ? 0 : size >= 9.995 ? 1 : size >= 0.9995 ? 2 : size >= 0.09995 ? 3 : 4;
}

bool isTiny(double percent) { return std::abs(percent) < 5e-5; }

} // namespace

std::string percentText(double value) {
    const double percent = 100.0 * value;
    if (!std::isfinite(percent)) return "–";
    if (isTiny(percent)) return std::abs(percent) < 5e-9 ? "0" : "< 0.0001 %";
    return fmt::format("{}{:.{}f} %", percent < 0.0 ? "−" : "", std::abs(percent), decimals(percent));
}

std::string percentText(const MeanDeviation& value) {
    const double mean = 100.0 * value.mean;
    if (!std::isfinite(mean) || isTiny(mean) || !(value.deviation > 0.0)) return percentText(value.mean);
    // As many decimals as show the deviation, and not more than either needs.
    int digits = decimals(std::max(std::abs(mean), 100.0 * value.deviation));
    while (digits < 4 && 100.0 * value.deviation < 0.5 * std::pow(10.0, -digits)) ++digits;
    return fmt::format("{3}{0:.{2}f} ± {1:.{2}f} %", std::abs(mean), 100.0 * value.deviation, digits,
                       mean < 0.0 ? "−" : "");
}

std::string percentLabel(double value) { return fmt::format("{:g} %", 100.0 * value); }

std::string countText(double value) {
    const char* const units[] = {"", " k", " M", " G", " T"};
    std::size_t unit = 0;
    while (value >= 999.5 && unit < 4) {
        value /= 1000.0;
        ++unit;
    }
    return fmt::format("{:.3g}{}", value, units[unit]);
}

std::string numberLabel(double value) {
    if (value >= 0.01 && value < 1e5) return fmt::format("{:g}", value);
    const int exponent = static_cast<int>(std::floor(std::log10(value) + 1e-9));
    const double mantissa = value / std::pow(10.0, exponent);
    const std::string power = fmt::format("10^{{{}{}}}", exponent < 0 ? "−" : "", std::abs(exponent));
    return mantissa < 1.5 ? power : fmt::format("{:.0f}·{}", mantissa, power);
}

std::string slopeText(const std::optional<PowerLaw>& law) {
    if (!law) return "–";
    const std::string slope = fmt::format("{}{:.2f}", law->exponent < 0.0 ? "−" : "", std::abs(law->exponent));
    return law->exponentError > 0.0 ? fmt::format("{} ± {:.2f}", slope, law->exponentError) : slope;
}

} // namespace lambert
