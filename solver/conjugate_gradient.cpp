// Orthomin(2): P. K. W. Vinsome, Orthomin, an iterative method for solving sparse sets of simultaneous linear equations,
//   4th SPE Symposium on Reservoir Simulation, 1976.
// Where it converges: S. C. Eisenstat, H. C. Elman, M. H. Schultz, Variational iterative methods for nonsymmetric systems of
//   linear equations, SIAM J. Numer. Anal. 20(2), 1983.
//
// With z = sqrt(A ρ) E the equation E = E_0 + F (B_e + ρ E) becomes (I − S) z = b, where
//
//     S_ij = sqrt(A_i ρ_i) F_ij sqrt(ρ_j / A_j),   b = sqrt(A ρ) (E_0 + F B_e).
//
// S is symmetric if A_i F_ij = A_j F_ji, and I − S positive definite if besides rows sum to at most 1 and ρ < 1. Patches of
// ρ = 0 drop out by themselves. On a symmetric system Orthomin is the method of conjugate residuals, as fast as conjugate
// gradients. On form factors from rays S is not quite symmetric; then a direction is made conjugate only to the two before it,
// and yet no step lets the residual grow.
#include "solver/conjugate_gradient.h"

#include "solver/energy_balance.h"
#include "solver/residual.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <array>
#include <limits>
#include <utility>

namespace lambert {

namespace {

using Vector = std::vector<RgbSum>;

constexpr std::size_t kDirections = 2;
constexpr int kMostIterations = 2'000;

/// Per channel.
RgbSum dot(const Vector& a, const Vector& b) {
    RgbSum sum(0.0);
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// a / b, 0 for a channel that has come to its end.
RgbSum ratio(const RgbSum& a, const RgbSum& b) {
    RgbSum result(0.0);
    for (int c = 0; c < 3; ++c)
        if (b[c] > 0.0) result[c] = a[c] / b[c];
    return result;
}

void add(Vector& a, const RgbSum& factor, const Vector& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * b[i];
}

class SymmetrisedSystem {
public:
    SymmetrisedSystem(const SolverProblem& problem, FormFactorRows& rows) : problem_(problem), rows_(rows) {}

    std::size_t size() const { return problem_.size(); }
    /// sqrt(A ρ)
    RgbSum scale(std::size_t i) const { return glm::sqrt(problem_.area(i) * problem_.reflectance(i)); }
    /// sqrt(ρ / A) z: the radiosity that is reflected.
    RgbSum reflected(std::size_t i, const RgbSum& z) const {
        return glm::sqrt(problem_.reflectance(i) / problem_.area(i)) * z;
    }

    /// product = (I − S) z
    void apply(const Vector& z, Vector& product, const Progress& progress) {
        radiosity_.resize(size());
        for (std::size_t i = 0; i < size(); ++i) radiosity_[i] = reflected(i, z[i]);
        gatherAll(rows_, radiosity_, product, progress);
        for (std::size_t i = 0; i < size(); ++i) product[i] = z[i] - scale(i) * product[i];
    }

    /// The relative residual of the radiosities from that of z.
    double relativeNorm(const Vector& residual) const {
        double squares = 0.0;
        for (std::size_t i = 0; i < size(); ++i)
            squares += glm::dot(problem_.reflectance(i) * residual[i], residual[i]);
        return problem_.relativeNorm(squares);
    }

private:
    const SolverProblem& problem_;
    FormFactorRows& rows_;
    Vector radiosity_;
};

struct Direction {
    Vector p, product; ///< product = (I − S) p
    RgbSum square{0.0};
};

class Orthomin {
public:
    explicit Orthomin(SymmetrisedSystem& system) : system_(system) {}

    /// Forgets all directions.
    void start(Vector residual) {
        residual_ = std::move(residual);
        directions_ = {};
        oldest_ = 0;
        squares_ = std::numeric_limits<double>::infinity();
        falls_ = true;
    }

    const Vector& residual() const { return residual_; }
    /// Whether the last step has still made the residual smaller.
    bool falls() const { return falls_; }

    /// Goes to the smallest residual along the next direction.
    void step(Vector& z, const Progress& progress) {
        Direction next{residual_, Vector(residual_.size()), {}};
        system_.apply(residual_, next.product, progress);
        for (const Direction& earlier : directions_) {
            if (earlier.p.empty()) continue;
            const RgbSum share = ratio(dot(next.product, earlier.product), earlier.square);
            add(next.p, -share, earlier.p);
            add(next.product, -share, earlier.product);
        }
        next.square = dot(next.product, next.product);
        const RgbSum length = ratio(dot(residual_, next.product), next.square);
        add(z, length, next.p);
        add(residual_, -length, next.product);
        const double sum = sumOf(dot(residual_, residual_));
        falls_ = sum < squares_;
        squares_ = sum;
        directions_[oldest_] = std::move(next);
        oldest_ = (oldest_ + 1) % kDirections;
    }

    /// Passes all that the next step depends on to an archive, see SolverCheckpoint.
    template <typename Archive>
    void keep(Archive& archive) {
        archive(residual_);
        for (Direction& direction : directions_) {
            archive(direction.p);
            archive(direction.product);
            archive(direction.square);
        }
        archive(oldest_);
        archive(squares_);
        archive(falls_);
    }

private:
    SymmetrisedSystem& system_;
    Vector residual_;
    std::array<Direction, kDirections> directions_;
    std::size_t oldest_ = 0;
    double squares_ = std::numeric_limits<double>::infinity(); ///< of residual_, all channels
    bool falls_ = true;
};

} // namespace

RadiositySolution solveConjugateGradient(const SolverProblem& problem, FormFactorRows& rows,
                                         const SolverOptions& options, Progress& progress,
                                         const SolverContext& context) {
    constexpr double kEnough = 0.5; // a start that gains less has reached what rounding allows
    const std::size_t count = problem.size();
    SymmetrisedSystem system(problem, rows);
    Orthomin method(system);
    RadiositySolution solution;
    Vector z(count, RgbSum(0.0));
    double before = 0.0; // residual at the last start
    const auto state = [&](auto& archive) {
        archive(solution.iterations);
        archive(solution.residual);
        archive(before);
        archive(z);
        archive(solution.history);
        method.keep(archive);
    };
    const bool restored = context.restore(state);
    const SolverClock clock(solution.history);
    const auto record = [&](double residual) {
        solution.residual = residual;
        solution.history.push_back({++solution.iterations, residual, clock.seconds()});
        progress.advance();
    };
    const auto unfinished = [&] {
        return solution.residual > options.tolerance && solution.iterations < kMostIterations;
    };
    /// The residual that was updated from step to step is not believed at start and end.
    const auto measure = [&] {
        for (std::size_t i = 0; i < count; ++i) {
            z[i] = glm::max(z[i], RgbSum(0.0)); // no light is negative, though what is next to none may come out so
            solution.radiosity[i] = problem.emitted(i) + system.reflected(i, z[i]);
        }
        record(gatherResidual(problem, rows, solution, progress));
    };
    solution.radiosity.resize(count);
    progress.begin("solve", 0);
    if (!restored) {
        for (std::size_t i = 0; i < context.start.size(); ++i) z[i] = system.scale(i) * context.start[i];
        measure();
    }
    bool inside = restored; // a state is kept before a step
    for (bool gains = true; inside || (gains && unfinished());) {
        if (!inside) {
            before = solution.residual;
            Vector residual(count);
            for (std::size_t i = 0; i < count; ++i) residual[i] = system.scale(i) * solution.irradiance[i] - z[i];
            method.start(std::move(residual));
        }
        do {
            if (!inside) context.offer(state);
            inside = false;
            method.step(z, progress);
            record(system.relativeNorm(method.residual()));
        } while (unfinished() && method.falls());
        measure();
        gains = solution.residual <= kEnough * before;
    }
    progress.end();
    // One more bounce, which was gathered for the residual.
    for (std::size_t i = 0; i < count; ++i) solution.radiosity[i] = problem.radiosity(i, solution.irradiance[i]);
    settle(problem, rows, solution, progress);
    return solution;
}

} // namespace lambert
