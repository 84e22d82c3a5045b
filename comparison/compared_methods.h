#pragma once

#include "baking/bake_scene.h"
#include "core/progress.h"
#include "formfactors/transport.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// A way to compute form factors with one number that says how much work it puts in.
struct ComparedMethod {
    TransportMethod method;
    std::string name;           //!< as for --method
    std::string effortName;     //!< what the number counts, such as "lines per patch"
    bool numberFirst;           //!< "4096 lines per patch" rather than "resolution 64"
    std::vector<double> ladder; //!< efforts that are compared if no others are asked for, ascending in cost
    bool random;                //!< other seeds give other factors
    double lowest, highest;     //!< efforts that are allowed
    double multiple;            //!< of which an effort is a whole multiple; 0: of nothing

    /// Its options with this effort, all others at their defaults.
    TransportOptions options(double effort, std::uint64_t seed, MatrixStorage storage) const;
    /// Throws Cancelled; SystemError if the matrix does not fit the options' memory limit.
    TransportMatrix compute(const MeshedScene& scene, double effort, std::uint64_t seed, MatrixStorage storage,
                            Progress& progress) const;
};

/// All there are.
std::span<const ComparedMethod> comparedMethods();

/// By name. Throws UsageError that says which there are.
const ComparedMethod& comparedMethod(std::string_view name);

/// An effort as a number: "64", "16 M".
std::string effortNumber(double effort);
/// "resolution 64", "4096 lines per patch".
std::string effortText(const ComparedMethod& method, double effort);

/// An effort as a text names it. Throws UsageError if the method does not allow it.
double parseEffort(const ComparedMethod& method, const std::string& text);

} // namespace lambert
