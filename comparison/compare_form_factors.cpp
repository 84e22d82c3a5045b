#include "comparison/compare_form_factors.h"

#include "core/process.h"
#include "core/stopwatch.h"
#include "formfactors/matrix_quality.h"
#include "solver/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lambert {

namespace {

/// Small against what is compared, so that the solver's error is not taken for the matrix's.
constexpr SolverOptions kSolve{.tolerance = 1e-7};

constexpr std::array kErrors{
    Measure{"relative_rms", "relative RMS", "RMS of F / F_ref − 1 over the pairs with F_ref above the threshold.",
            &RunMeasures::relativeRms},
    Measure{"bias", "bias", "Mean of the same, signed: 0 within its deviation for an unbiased method.",
            &RunMeasures::bias},
    Measure{"rms", "RMS", "RMS of F − F_ref over all pairs, those that do not see each other too.", &RunMeasures::rms},
    Measure{"maximum", "largest", "The largest |F − F_ref|.", &RunMeasures::maximum},
    Measure{
        "misdirected", "sent astray",
        "Share of the light that a patch sends which the row takes to a wrong place: half the sum of |F − F_ref| over "
        "a row, black backs and the outside included, weighted by area.",
        &RunMeasures::misdirected},
    Measure{"row_closure", "rows' closure",
            "RMS over the patches of how far a row's sum is from 1. Whoever counts lines has 0: it proves nothing for "
            "them.",
            &RunMeasures::rowClosure},
    Measure{"column_closure", "columns' closure",
            "RMS over the patches of how far from 1 that is which a patch receives if every surface sends 1 per m²: it "
            "needs no reference, "
            "and is what shooting solvers see.",
            &RunMeasures::columnClosure},
    Measure{"reciprocity", "reciprocity",
            "RMS of A_i F_ij − A_j F_ji over the pairs, relative to the RMS of their mean; above 4,000 patches over "
            "those of "
            "256 rows.",
            &RunMeasures::reciprocity},
    Measure{
        "radiosity", "radiosity",
        "Error of the radiosity solved from the matrix: RMS weighted by area, relative to the reflected light of the "
        "reference's solution.",
        &RunMeasures::radiosity}};

constexpr std::array kCosts{
    Measure{"rays", "rays", "Rays or lines traced.", &RunMeasures::rays},
    Measure{"cpu_seconds", "CPU s", "Processor time of the matrix, all threads.", &RunMeasures::processorSeconds},
    Measure{"wall_seconds", "wall s", "Time on the clock of the matrix.", &RunMeasures::wallSeconds},
    Measure{"bytes", "bytes", "Memory that the matrix takes.", &RunMeasures::bytes}};

/// One comparison on its way.
class Run {
public:
    Run(const MeshedScene& scene, const FormFactorComparisonOptions& options, Progress& progress)
        : scene_(scene), options_(options), progress_(progress) {
        const auto& emitted = scene.optics.emittedRadiosity;
        result_.lit = std::any_of(emitted.begin(), emitted.end(), [](const Rgb& b) { return b != Rgb(0.0F); });
        result_.threshold = options.threshold.value_or(0.1 / static_cast<double>(scene.mesh.size()));
    }

    FormFactorComparison operator()() {
        options_.onRun("reference");
        const double start = processorSeconds();
        reference_ = makeReference(options_.reference, scene_, options_.seed, result_.threshold, progress_);
        result_.referenceSeconds = processorSeconds() - start;
        result_.reference = reference_.description;
        result_.referenceError = reference_.ownError;
        if (result_.lit) result_.referenceSolution = solved(reference_.matrix);
        for (const auto& [method, efforts] : options_.ladders) {
            MethodResult& of = result_.methods.emplace_back();
            of.method = method;
            for (const double effort : efforts) of.efforts.push_back(runEffort(of, effort, effort == efforts.back()));
        }
        return std::move(result_);
    }

private:
    EffortResult runEffort(MethodResult& of, double effort, bool last) {
        EffortResult result;
        result.effort = effort;
        std::vector<FormFactorMatrix> matrices;
        const int seeds = of.method->random ? options_.seeds : 1;
        for (int k = 0; k < seeds; ++k) {
            options_.onRun(fmt::format("{} {}, seed {} of {}", of.method->name, effortNumber(effort), k + 1, seeds));
            RunMeasures& run = result.runs.emplace_back();
            const Stopwatch watch;
            const double start = processorSeconds();
            TransportMatrix computed = of.method->compute(scene_, effort, options_.seed + static_cast<std::uint64_t>(k),
                                                          MatrixStorage::Float, progress_);
            run.processorSeconds = processorSeconds() - start;
            run.wallSeconds = watch.seconds();
            run.rays = static_cast<double>(computed.rays);
            run.bytes = static_cast<double>(computed.matrix.bytes());
            assess(computed.matrix, run, last && k == 0 ? &of : nullptr);
            matrices.push_back(std::move(computed.matrix));
            progress_.throwIfCancelled();
        }
        result.systematic = of.method->random ? systematicError(matrices, reference_.matrix, result_.threshold)
                                              : std::optional(result.runs.front().relativeRms);
        // The reference's own noise is the same for every seed too.
        if (result.systematic && result_.referenceError)
            result.systematic = std::sqrt(std::max(0.0, *result.systematic * *result.systematic -
                                                            *result_.referenceError * *result_.referenceError));
        if (last) of.bySize = errorsBySize(matrices, reference_.matrix);
        return result;
    }

    /// Compares one matrix; `shown`, if given, keeps what is drawn per patch.
    void assess(const FormFactorMatrix& matrix, RunMeasures& run, MethodResult* shown) {
        FormFactorErrors errors = formFactorErrors(matrix, reference_.matrix, scene_.mesh.area, result_.threshold);
        run.relativeRms = errors.relativeRms;
        run.bias = errors.bias;
        run.rms = errors.rms;
        run.maximum = errors.maximum;
        run.misdirected = errors.misdirected;
        const MatrixQuality quality = assessMatrix(matrix, scene_.mesh.area);
        ColumnClosure columns = columnClosure(matrix, scene_.mesh.area);
        run.rowClosure = quality.closureRms;
        run.columnClosure = columns.rms;
        run.reciprocity = quality.reciprocityRms;
        if (result_.lit) {
            const RadiositySolution solution = solved(matrix);
            run.radiosity =
                radiosityError(scene_.mesh, scene_.optics, solution.radiosity, result_.referenceSolution.radiosity);
        }
        if (shown == nullptr) return;
        shown->misdirectedBy = std::move(errors.misdirectedBy);
        shown->columnClosure = std::move(columns.error);
    }

    RadiositySolution solved(const FormFactorMatrix& matrix) {
        StoredRows rows(matrix);
        return solve(SolverProblem({scene_.mesh, scene_.optics}), rows, kSolve, progress_);
    }

    const MeshedScene& scene_;
    const FormFactorComparisonOptions& options_;
    Progress& progress_;
    ReferenceMatrix reference_;
    FormFactorComparison result_;
};

} // namespace

std::span<const Measure> errorMeasures() { return kErrors; }
std::span<const Measure> costMeasures() { return kCosts; }

const Measure& measure(std::string_view key) {
    const auto isIt = [&](const Measure& m) { return m.key == key; };
    const auto error = std::find_if(kErrors.begin(), kErrors.end(), isIt);
    return error != kErrors.end() ? *error : *std::find_if(kCosts.begin(), kCosts.end(), isIt);
}

MeanDeviation EffortResult::of(const Measure& measure) const {
    std::vector<double> values;
    for (const RunMeasures& run : runs) values.push_back(run.*measure.value);
    return meanDeviation(values);
}

std::vector<double> MethodResult::means(const Measure& measure) const {
    std::vector<double> values;
    for (const EffortResult& effort : efforts) values.push_back(effort.of(measure).mean);
    return values;
}

std::optional<PowerLaw> MethodResult::law(const Measure& cost, const Measure& error) const {
    return fitPowerLaw(means(cost), means(error));
}

FormFactorComparison compareFormFactors(const MeshedScene& scene, const FormFactorComparisonOptions& options,
                                        Progress& progress) {
    return Run(scene, options, progress)();
}

} // namespace lambert
