#include "vpl/vpl_method.h"

#include <algorithm>
#include <cmath>

namespace lambert {

std::vector<double> VplMethod::ladder(double effort) const {
    const VplEffort bounds = this->effort();
    std::vector<double> steps;
    for (const double factor : {1.0 / 16.0, 1.0 / 4.0, 1.0, 4.0, 16.0}) {
        const double step = std::clamp(std::floor(factor * effort), bounds.least, bounds.most);
        if (steps.empty() || step > steps.back()) steps.push_back(step);
    }
    return steps;
}

} // namespace lambert
