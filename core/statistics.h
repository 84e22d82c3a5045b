#pragma once

#include <optional>
#include <span>

namespace lambert {

struct MeanDeviation {
    double mean = 0.0;
    double deviation = 0.0; //!< of one value from the mean (n − 1 in the denominator); 0 for a single value
};

/// Of at least one value.
MeanDeviation meanDeviation(std::span<const double> values);

/// y = coefficient · x^exponent.
struct PowerLaw {
    double exponent = 0.0; //!< the slope on log-log axes
    double coefficient = 0.0;
    double exponentError = 0.0; //!< standard error of the exponent from the residuals; 0 for two points
    double at(double x) const;
};

/// The line of least squares through the points (log x, log y). Points that are not positive and finite are left out;
/// nothing if fewer than two different x remain. `x` and `y` have the same length.
std::optional<PowerLaw> fitPowerLaw(std::span<const double> x, std::span<const double> y);

/// The cost at which the error first falls to `target`, between measured points by a power law each; cost ascending.
/// Nothing if no point reaches it, or if the first one does so already (then the cost is unknown).
std::optional<double> costToReach(double target, std::span<const double> cost, std::span<const double> error);

} // namespace lambert
