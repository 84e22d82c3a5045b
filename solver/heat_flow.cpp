#include "solver/heat_flow.h"

#include "core/error.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lambert {

namespace {

using Vector = std::vector<double>;

double dot(const Vector& a, const Vector& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

double power4(double kelvin) { return kelvin * kelvin * kelvin * kelvin; }

/// (I − diag(reflectance) F) x.
class Operator {
public:
    Operator(const FormFactorMatrix& matrix, const Vector& reflectance) : matrix_(matrix), reflectance_(reflectance) {}

    void gather(const Vector& x, Vector& result) const {
        parallelFor(matrix_.size(), 64, [&](std::size_t begin, std::size_t end, int) {
            for (std::size_t i = begin; i < end; ++i) {
                double sum = 0.0;
                matrix_.visit(i, [&](std::uint32_t j, double factor) { sum += factor * x[j]; });
                result[i] = sum;
            }
        });
    }
    void apply(const Vector& x, Vector& result) const {
        gather(x, result);
        for (std::size_t i = 0; i < x.size(); ++i) result[i] = x[i] - reflectance_[i] * result[i];
    }

private:
    const FormFactorMatrix& matrix_;
    const Vector& reflectance_;
};

/// Solves A x = b from the x given; letters as in the paper.
void solve(const Operator& a, const Vector& b, Vector& x, const HeatFlowOptions& options, HeatFlow& result,
           Progress& progress) {
    const std::size_t n = b.size();
    Vector r(n), p(n, 0.0), v(n, 0.0), s(n), t(n);
    const double norm = std::sqrt(dot(b, b));
    double rho = 1.0, alpha = 1.0, omega = 1.0;
    Vector shadow;
    const auto restart = [&] {
        a.apply(x, r);
        for (std::size_t i = 0; i < n; ++i) r[i] = b[i] - r[i];
        shadow = r;
        std::fill(p.begin(), p.end(), 0.0);
        std::fill(v.begin(), v.end(), 0.0);
        rho = alpha = omega = 1.0;
        result.residual = norm > 0.0 ? std::sqrt(dot(r, r)) / norm : 0.0;
    };
    restart();
    while (result.residual > options.tolerance && result.iterations < options.maxIterations) {
        ++result.iterations;
        progress.advance();
        const double next = dot(shadow, r);
        const double beta = next / rho * (alpha / omega);
        rho = next;
        for (std::size_t i = 0; i < n; ++i) p[i] = r[i] + beta * (p[i] - omega * v[i]);
        a.apply(p, v);
        alpha = rho / dot(shadow, v);
        for (std::size_t i = 0; i < n; ++i) s[i] = r[i] - alpha * v[i];
        a.apply(s, t);
        const double tt = dot(t, t);
        omega = tt > 0.0 ? dot(t, s) / tt : 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            x[i] += alpha * p[i] + omega * s[i];
            r[i] = s[i] - omega * t[i];
        }
        result.residual = std::sqrt(dot(r, r)) / norm;
        if (!std::isfinite(result.residual)) { // a breakdown: again, from elsewhere
            x = b;
            for (int k = 0; k < 10 && result.iterations < options.maxIterations; ++k, ++result.iterations) {
                a.apply(x, r);
                for (std::size_t i = 0; i < n; ++i) x[i] += b[i] - r[i];
            }
            restart();
            continue;
        }
        // The recursive residual is not believed at the end.
        if (result.residual <= options.tolerance || omega == 0.0) restart();
    }
}

} // namespace

double HeatFlow::imbalance() const { return std::accumulate(flow.begin(), flow.end(), environmentFlow + backFlow); }

HeatFlow solveHeatFlow(const FormFactorMatrix& matrix, std::span<const float> area,
                       std::span<const std::uint32_t> group, std::span<const ThermalSurface> surfaces,
                       const HeatFlowOptions& options, Progress& progress) {
    const std::size_t count = matrix.size();
    const double environment = kStefanBoltzmann * power4(options.environment);
    Vector reflectance(count, 0.0), emitted(count, 0.0);
    bool fixed = false;
    for (std::size_t i = 0; i < count; ++i) {
        if (group[i] == kNoGroup) continue;
        const ThermalSurface& surface = surfaces[group[i]];
        fixed = fixed || (surface.kelvin && surface.emissivity > 0.0) || matrix.out(i) > 0.0;
        reflectance[i] = surface.kelvin ? 1.0 - surface.emissivity : 1.0;
        emitted[i] = (1.0 - reflectance[i]) * kStefanBoltzmann * power4(surface.kelvin.value_or(0.0)) +
                     reflectance[i] * matrix.out(i) * environment;
    }
    if (!fixed)
        throw InputError("no surface has a temperature and an emissivity above 0: nothing settles the radiation");

    HeatFlow result;
    progress.begin("heat flow", 0);
    const Operator a(matrix, reflectance);
    result.radiosity = emitted;
    solve(a, emitted, result.radiosity, options, result, progress);
    result.irradiance.resize(count);
    a.gather(result.radiosity, result.irradiance);
    progress.end();

    result.flow.assign(surfaces.size(), 0.0);
    Vector groupArea(surfaces.size(), 0.0), given(surfaces.size(), 0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const auto ai = static_cast<double>(area[i]);
        result.irradiance[i] += matrix.out(i) * environment;
        if (group[i] == kNoGroup) {
            result.backFlow -= ai * (result.irradiance[i] - matrix.out(i) * environment);
            continue;
        }
        result.flow[group[i]] += ai * (result.radiosity[i] - result.irradiance[i]);
        groupArea[group[i]] += ai;
        given[group[i]] += ai * result.radiosity[i];
        result.environmentFlow += ai * matrix.out(i) * (environment - result.radiosity[i]);
        result.backFlow -= ai * matrix.back(i) * result.radiosity[i];
    }
    for (std::size_t g = 0; g < surfaces.size(); ++g)
        result.kelvin.push_back(surfaces[g].kelvin.value_or(
            groupArea[g] > 0.0 ? std::pow(std::max(0.0, given[g] / groupArea[g]) / kStefanBoltzmann, 0.25) : 0.0));
    return result;
}

} // namespace lambert
