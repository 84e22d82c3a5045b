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

} // namespace lambert
