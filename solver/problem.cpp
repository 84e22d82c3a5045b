#include "solver/problem.h"

#include "core/checksum.h"
#include "core/error.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <utility>

namespace lambert {

SolverProblem::SolverProblem(const PatchViews& patches, std::vector<RgbSum> directIrradiance,
                             const std::vector<RgbSum>& emittersIrradiance)
    : patches_(patches), direct_(std::move(directIrradiance)), emittersApart_(!emittersIrradiance.empty()) {
    for (std::size_t i = 0; i < direct_.size(); ++i) received_ += area(i) * direct_[i];
    if (emittersApart_) {
        direct_.resize(size(), RgbSum(0.0));
        for (std::size_t i = 0; i < size(); ++i) direct_[i] += emittersIrradiance[i];
    }
    double squares = 0.0;
    bool lit = false;
    for (std::size_t i = 0; i < size(); ++i) {
        const RgbSum b = source(i);
        squares += area(i) * glm::dot(b, b);
        const RgbSum e = direct(i);
        lit = lit || area(i) * glm::dot(e, e) > 0.0 || allEmitted(i) != RgbSum(0.0);
    }
    if (!(squares > 0.0) && !lit)
        throw InputError("the scene has no light: no material emits, and no light without area reaches a "
                         "front; give one with --emit MATERIAL=r,g,b");
    sourceNorm_ = std::sqrt(squares);
}

std::vector<RgbSum> SolverProblem::emitted() const {
    std::vector<RgbSum> result(size());
    for (std::size_t i = 0; i < size(); ++i) result[i] = emitted(i);
    return result;
}

std::vector<RgbSum> SolverProblem::startRadiosity(std::span<const RgbSum> start) const {
    std::vector<RgbSum> result = emitted();
    for (std::size_t i = 0; i < start.size(); ++i) result[i] = radiosity(i, start[i]);
    return result;
}

std::uint64_t SolverProblem::checksum() const {
    Checksum sum;
    sum.add(std::as_bytes(patches_.area));
    sum.add(std::as_bytes(patches_.reflectance));
    sum.add(std::as_bytes(patches_.emittedRadiosity));
    sum.add(direct_);
    sum.add(std::uint64_t{emittersApart_});
    return sum.value();
}

double SolverProblem::sumOfSquares(std::span<const RgbSum> values) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < size(); ++i) sum += area(i) * glm::dot(values[i], values[i]);
    return sum;
}

double SolverProblem::relativeNorm(std::span<const RgbSum> values) const { return relativeNorm(sumOfSquares(values)); }

double SolverProblem::relativeNorm(double sumOfSquares) const {
    // Where lights without area fall on nothing but black, there is no radiosity at all.
    return sourceNorm_ > 0.0 ? std::sqrt(sumOfSquares) / sourceNorm_ : 0.0;
}

} // namespace lambert
