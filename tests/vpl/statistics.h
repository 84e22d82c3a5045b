#pragma once

#include <cmath>
#include <vector>

namespace lambert {

/// Mean and standard error of independent values.
struct MeanOfRuns {
    double mean = 0.0, standardError = 0.0;

    explicit MeanOfRuns(const std::vector<double>& values) {
        const auto n = static_cast<double>(values.size());
        double squares = 0.0;
        for (const double value : values) mean += value / n;
        for (const double value : values) squares += (value - mean) * (value - mean);
        standardError = std::sqrt(squares / (n * (n - 1.0)));
    }
};

/// Slope of a straight line through the logarithms of both, by least squares.
inline double logarithmicSlope(const std::vector<double>& x, const std::vector<double>& y) {
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double a = std::log(x[k]), b = std::log(y[k]);
        sx += a;
        sy += b;
        sxx += a * a;
        sxy += a * b;
    }
    const auto n = static_cast<double>(x.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

} // namespace lambert
