#pragma once

#include "comparison/form_factor_errors.h"
#include "comparison/reference_matrix.h"
#include "core/statistics.h"
#include "solver/solution.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lambert {

/// What one matrix cost, and how it errs.
struct RunMeasures {
    double relativeRms = 0.0, bias = 0.0, rms = 0.0, maximum = 0.0;  //!< see FormFactorErrors
    double misdirected = 0.0;                                        //!< the same
    double rowClosure = 0.0, columnClosure = 0.0, reciprocity = 0.0; //!< see MatrixQuality and ColumnClosure, RMS
    double radiosity = 0.0;                                          //!< see radiosityError; 0 in a scene without light
    double rays = 0.0;
    double processorSeconds = 0.0, wallSeconds = 0.0; //!< of the matrix, without solving
    double bytes = 0.0;                               //!< of the matrix
};

/// One of these figures, for tables, files and axes.
struct Measure {
    const char* key;     //!< in JSON and CSV
    const char* name;    //!< as a heading
    const char* meaning; //!< a sentence
    double RunMeasures::*value;
};
std::span<const Measure> errorMeasures();
std::span<const Measure> costMeasures();
/// By its key, of either kind, which must exist.
const Measure& measure(std::string_view key);

/// A method at one effort, with several seeds.
struct EffortResult {
    double effort = 0.0;
    std::vector<RunMeasures> runs; //!< #seeds, or one of a method that is not random
    std::optional<double>
        systematic; //!< see systematicError; all of a method that is not random. Without the reference's own error
    MeanDeviation of(const Measure& measure) const;
};

struct MethodResult {
    const ComparedMethod* method = nullptr;
    std::vector<EffortResult> efforts;
    // At the last effort:
    std::vector<FactorSizeError> bySize; //!< over all seeds
    std::vector<float> misdirectedBy;    //!< #patches, first seed
    std::vector<float> columnClosure;    //!< #patches, first seed

    std::vector<double> means(const Measure& measure) const; //!< #efforts
    /// The power law of an error over a cost.
    std::optional<PowerLaw> law(const Measure& cost, const Measure& error) const;
};

struct FormFactorComparisonOptions {
    struct Ladder {
        const ComparedMethod* method;
        std::vector<double> efforts; //!< in the order in which they are computed and shown
    };
    std::vector<Ladder> ladders;
    ReferenceChoice reference;
    int seeds = 5;                   //!< runs of each method and effort, >= 1
    std::uint64_t seed = 1;          //!< of the first run; the others follow
    std::optional<double> threshold; //!< smallest factor that counts in relative errors; none: a tenth of 1 / #patches
    std::function<void(const std::string&)> onRun = [](const std::string&) {}; //!< told what begins
};

struct FormFactorComparison {
    std::string reference;                //!< for people
    std::optional<double> referenceError; //!< see ReferenceMatrix
    double referenceSeconds = 0.0;        //!< of processor time
    double threshold = 0.0;
    bool lit = false;                    //!< the scene has a light: radiosity is compared
    RadiositySolution referenceSolution; //!< of a lit scene
    std::vector<MethodResult> methods;
};

/// Computes each method's matrices and compares them with the reference. Results but for the times depend on nothing but scene,
/// options and seed. Throws UsageError, InputError (see makeReference), Cancelled.
FormFactorComparison compareFormFactors(const MeshedScene& scene, const FormFactorComparisonOptions& options,
                                        Progress& progress);

} // namespace lambert
