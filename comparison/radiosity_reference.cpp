#include "comparison/radiosity_reference.h"

#include "core/random.h"
#include "formfactors/transport.h"
#include "solver/direct_light.h"
#include "solver/emitter_light.h"
#include "solver/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lambert {

namespace {

constexpr double kFewestLines = 1024, kMostLines = 16384; ///< per patch
constexpr double kLeastRefinement = 1.4;                  ///< of patch lengths from mesh to mesh, where 2 is aimed at
constexpr double kLowestOrder = 1.0, kHighestOrder = 2.0;
constexpr double kLineRatio = 4.0; ///< of the two sets of lines

/// Small against what is compared.
constexpr SolverOptions kSolve{.tolerance = 1e-6};

/// Patches `factor` times as long as those of the scene's mesh.
MeshOptions scaledMesh(const MeshedScene& scene, MeshOptions options, double factor) {
    if (std::isfinite(scene.meshReport.patchLength)) {
        options.patchLength = factor * scene.meshReport.patchLength;
        options.patches.reset();
    } else {
        options.patches = static_cast<std::size_t>(static_cast<double>(scene.mesh.size()) / (factor * factor));
    }
    return options;
}

/// By how much patches become shorter.
double refinement(const PatchMesh& coarse, const PatchMesh& fine) {
    return std::sqrt(static_cast<double>(fine.size()) / static_cast<double>(coarse.size()));
}

/// The irradiance of patches by light that was reflected 0, 1, ... bounces − 1 times.
std::vector<std::vector<RgbSum>> solvedByBounce(const SolverProblem& problem, FormFactorRows& rows, int bounces,
                                                Progress& progress) {
    std::vector<std::vector<RgbSum>> result;
    std::vector<RgbSum> radiosity = problem.emitted();
    for (int k = 0; k < bounces; ++k) {
        std::vector<RgbSum>& irradiance = result.emplace_back(problem.size());
        gatherAll(rows, radiosity, irradiance, progress);
        for (std::size_t i = 0; i < problem.size(); ++i) {
            if (k == 0) irradiance[i] += problem.direct(i);
            radiosity[i] = problem.reflectance(i) * irradiance[i];
        }
    }
    return result;
}

struct Solved {
    std::vector<std::vector<RgbSum>> irradiance; ///< as Level::irradiance
    double imbalance = 0.0;                      ///< of the energy
};

/// Form factors carry only what is reflected: direct light, of
/// which lines that meet small emitters would give a noisy account, is found for itself.
Solved solved(const PatchMesh& mesh, const PatchOptics& optics, const RayCaster& rays, std::uint32_t lines, int bounces,
              std::uint64_t seed, Progress& progress) {
    std::vector<RgbSum> direct = DirectLight(rays, {.seed = seed}).irradiance(mesh, lightsOf(rays.scene()), progress);
    const std::vector<RgbSum> emitted = EmitterLight(rays, mesh, optics, seed).irradiance(mesh, progress);
    for (std::size_t i = 0; i < mesh.size(); ++i) direct[i] += emitted[i];
    const auto isDark = [](const auto& light) { return light.x + light.y + light.z == 0; };
    if (std::all_of(direct.begin(), direct.end(), isDark))
        return {std::vector(static_cast<std::size_t>(1 + bounces), direct)}; // lamps that nothing sees
    const std::vector<Rgb> nothing(mesh.size(), Rgb(0.0F));
    PatchViews reflecting(mesh, optics);
    reflecting.emittedRadiosity = nothing;
    const SolverProblem problem(reflecting, std::move(direct));
    TransportOptions options;
    options.method = TransportMethod::LocalLines;
    options.lines = lines;
    options.seed = seed;
    const TransportMatrix matrix = computeMatrix(planTransport(options, mesh, rays, progress), mesh, rays, progress);
    StoredRows rows(matrix.matrix);
    Solved result{solvedByBounce(problem, rows, bounces, progress)};
    RadiositySolution solution = solve(problem, rows, kSolve, progress);
    result.irradiance.insert(result.irradiance.begin(), std::move(solution.irradiance));
    result.imbalance = solution.energy.imbalance();
    return result;
}

/// Sums over the points and channels of fields at them.
class Norms {
public:
    explicit Norms(std::span<const double> weight) : weight_(weight) {
        for (const double w : weight) total_ += 3.0 * w;
    }
    double rms(std::span<const RgbSum> a, std::span<const RgbSum> b) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < weight_.size(); ++i) {
            const RgbSum d = a[i] - b[i];
            sum += weight_[i] * (d.x * d.x + d.y * d.y + d.z * d.z);
        }
        return std::sqrt(sum / total_);
    }
    /// |mean of a − b|.
    double mean(std::span<const RgbSum> a, std::span<const RgbSum> b) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < weight_.size(); ++i) {
            const RgbSum d = a[i] - b[i];
            sum += weight_[i] * (d.x + d.y + d.z);
        }
        return std::abs(sum / total_);
    }

private:
    std::span<const double> weight_;
    double total_ = 0.0;
};

std::vector<RgbSum> combined(double a, std::span<const RgbSum> x, double b, std::span<const RgbSum> y) {
    std::vector<RgbSum> result(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) result[i] = a * x[i] + b * y[i];
    return result;
}

} // namespace

double OwnError::total() const { return std::sqrt(mesh * mesh + transport * transport + gathering * gathering); }

RadiosityReference::RadiosityReference(const MeshedScene& scene, const ReferenceOptions& options, Progress& progress)
    : scene_(scene) {
    const RayCaster& rays = *scene.rays;
    const auto addLevel = [&](PatchMesh mesh) {
        PatchOptics optics = patchOptics(*scene.scene, mesh);
        levels_.push_back({std::move(mesh), std::move(optics), {}});
    };
    progress.begin("mesh", 0);
    PatchMesh coarse = buildPatchMesh(*scene.scene, scaledMesh(scene, options.mesh, 2.0), progress);
    if (refinement(coarse, scene.mesh) >= kLeastRefinement) addLevel(std::move(coarse));
    levels_.push_back({scene.mesh, scene.optics, {}});
    PatchMesh fine = buildPatchMesh(*scene.scene, scaledMesh(scene, options.mesh, 0.5), progress);
    progress.end();
    if (fine.size() > scene.mesh.size()) addLevel(std::move(fine));

    const double perPatch = options.lines / static_cast<double>(levels_.back().mesh.size());
    lines_ =
        static_cast<std::uint32_t>(std::exp2(std::floor(std::log2(std::clamp(perPatch, kFewestLines, kMostLines)))));
    std::uint32_t set = 0;
    const auto solution = [&](const Level& level, std::uint32_t lines) {
        options.onStage(fmt::format("reference, {} patches, {} lines", level.mesh.size(), lines));
        return solved(level.mesh, level.optics, rays, lines, options.bounces,
                      randomKey({set++, 0, 0, 0x52454652}, options.seed), progress);
    };
    for (Level& level : levels_) {
        Solved found = solution(level, lines_);
        level.irradiance = std::move(found.irradiance);
        if (std::abs(found.imbalance) > std::abs(imbalance_)) imbalance_ = found.imbalance;
    }
    fewerLines_ = solution(levels_.back(), static_cast<std::uint32_t>(lines_ / kLineRatio)).irradiance;
}

std::vector<std::size_t> RadiosityReference::patches() const {
    std::vector<std::size_t> result;
    for (const Level& level : levels_) result.push_back(level.mesh.size());
    return result;
}

ReferenceLight RadiosityReference::at(std::span<const Receiver> receivers, std::span<const double> weight,
                                      const PointGatherOptions& options, Progress& progress) const {
    std::vector<PatchLight> lights;
    for (const Level& level : levels_) lights.push_back({&level.mesh, &level.optics, level.irradiance[0]});
    lights.push_back({&levels_.back().mesh, &levels_.back().optics, fewerLines_[0]});
    PointGatherOptions other = options;
    other.seed = ~options.seed;
    return extrapolated({gatherAtPoints(*scene_.rays, lights, receivers, options, progress),
                         gatherAtPoints(*scene_.rays, lights, receivers, other, progress)},
                        weight);
}

std::vector<ReferenceLight> RadiosityReference::byBounce(std::span<const Receiver> receivers,
                                                         std::span<const double> weight,
                                                         const PointGatherOptions& options, Progress& progress) const {
    // From dark patches comes what was not reflected; from those lit by light of k reflections, with the same rays,
    // that and what is reflected once more.
    std::vector<Field> dark;
    for (const Level& level : levels_) dark.emplace_back(level.mesh.size(), RgbSum(0.0));
    dark.push_back(dark.back());
    std::vector<PatchLight> lights;
    for (std::size_t bounce = 0; bounce < levels_.back().irradiance.size(); ++bounce) {
        for (std::size_t k = 0; k <= levels_.size(); ++k) {
            const bool fewer = k == levels_.size();
            const Level& level = fewer ? levels_.back() : levels_[k];
            lights.push_back(
                {&level.mesh, &level.optics, bounce == 0 ? dark[k] : (fewer ? fewerLines_ : level.irradiance)[bounce]});
        }
    }
    PointGatherOptions other = options;
    other.seed = ~options.seed;
    const std::array all{gatherAtPoints(*scene_.rays, lights, receivers, options, progress),
                         gatherAtPoints(*scene_.rays, lights, receivers, other, progress)};
    std::vector<ReferenceLight> result;
    const std::size_t fields = levels_.size() + 1;
    for (std::size_t first = 0; first < lights.size(); first += fields) {
        Gathered gathered;
        for (std::size_t k = 0; k < fields; ++k) {
            const double unreflected = first == 0 ? 0.0 : -1.0;
            gathered.first.push_back(combined(1.0, all[0][first + k], unreflected, all[0][k]));
            gathered.second.push_back(combined(1.0, all[1][first + k], unreflected, all[1][k]));
        }
        result.push_back(extrapolated(gathered, weight));
    }
    return result;
}

ReferenceLight RadiosityReference::extrapolated(const Gathered& gathered, std::span<const double> weight) const {
    const auto& [first, second] = gathered;
    const Norms norms(weight);
    const std::size_t finest = levels_.size() - 1;
    std::vector<std::vector<RgbSum>> mean;
    for (std::size_t k = 0; k < first.size(); ++k) mean.push_back(combined(0.5, first[k], 0.5, second[k]));

    ReferenceLight result;
    double ahead = 0.0; // by how much of the last difference the extrapolated value lies beyond the finest
    if (finest > 0) {
        const double ratio = refinement(levels_[finest - 1].mesh, levels_[finest].mesh);
        if (finest > 1) {
            const double before = norms.rms(mean[finest - 1], mean[finest - 2]);
            const double last = norms.rms(mean[finest], mean[finest - 1]);
            const double found = last > 0.0 ? std::log(before / last) / std::log(ratio) : kHighestOrder;
            result.order = std::clamp(found, kLowestOrder, kHighestOrder);
            result.orderFound = found == result.order;
        }
        ahead = 1.0 / (std::pow(ratio, result.order) - 1.0);
    }
    const auto limit = [&](const std::vector<std::vector<RgbSum>>& of) {
        return finest > 0 ? combined(1.0 + ahead, of[finest], -ahead, of[finest - 1]) : of[finest];
    };
    result.irradiance = limit(mean);

    // A quarter of the lines has twice the noise: the difference is √5 times that of the finer set. Extrapolation makes it larger,
    // and adds that of the coarser mesh, which fewer patches average.
    const double noise = std::sqrt(((1.0 + ahead) * (1.0 + ahead) + kLineRatio * ahead * ahead) / (1.0 + kLineRatio));
    const auto oneHalf = limit(first);
    result.rms = {norms.rms(result.irradiance, mean[finest]), noise * norms.rms(mean.back(), mean[finest]),
                  norms.rms(oneHalf, result.irradiance)};
    result.mean = {norms.mean(result.irradiance, mean[finest]), noise * norms.mean(mean.back(), mean[finest]),
                   norms.mean(oneHalf, result.irradiance)};
    return result;
}

} // namespace lambert
