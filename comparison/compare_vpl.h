#pragma once

#include "comparison/error_anatomy.h"
#include "comparison/field_errors.h"
#include "comparison/radiosity_reference.h"
#include "core/statistics.h"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lambert {

/// How far light at points is from a reference.
struct LightErrors {
    FieldErrors overall;                 //!< over all points and the three channels
    std::array<FieldErrors, 3> channels; //!< over all points
};
LightErrors lightErrors(std::span<const double> weight, std::span<const RgbSum> reference,
                        std::span<const RgbSum> light);

/// A method with one seed.
struct VplRun {
    LightErrors errors;
    double lights = 0.0, rays = 0.0;
    double wallSeconds = 0.0, processorSeconds = 0.0;
};

/// A method at one effort, with several seeds.
struct VplRung {
    double effort = 0.0;
    std::vector<VplRun> runs;
    double sampling = 0.0; //!< RMS of what other seeds would change, in the unit of E

    MeanDeviation of(const std::function<double(const VplRun&)>& value) const;
    MeanDeviation of(double FieldErrors::*value) const; //!< overall
};

/// Light that was reflected so many times.
struct VplBounce {
    std::vector<LightErrors> runs; //!< #seeds
    bool significant = true;       //!< whether their RMS error is above the reference's own error in this light

    MeanDeviation of(double FieldErrors::*value) const; //!< overall
};

struct VplMethodResult {
    std::shared_ptr<const VplMethod> method;
    std::vector<VplRung> ladder; //!< ascending
    std::size_t main = 0;        //!< the rung of the anatomy
    ErrorAnatomy anatomy;
    bool significant = true;                   //!< whether the RMS error there is above the reference's own error
    std::vector<std::vector<float>> partSizes; //!< see partSizes()
    std::vector<VplBounce> bounces;            //!< at the effort of the anatomy; empty unless asked for and known
};

struct VplComparisonOptions {
    std::vector<std::shared_ptr<const VplMethod>> methods;
    double effort = 1024.0;                    //!< of the anatomy, at least 1
    std::optional<std::vector<double>> ladder; //!< further efforts; none: those of each method, see VplMethod::ladder
    int seeds = 16;                            //!< runs of each, >= 3
    std::uint64_t seed = 1;                    //!< of the first run; the others follow
    bool perBounce = false;                    //!< compares each bounce, as many as the reference knows apart
    PointGatherOptions gathering;              //!< of the reference at the receivers
    std::function<void(const std::string&)> onStage = [](const std::string&) {}; //!< told what begins
};

struct VplComparison {
    ComparedPoints points;                        //!< the patches' centres
    std::vector<std::uint32_t> patches;           //!< #points
    ReferenceLight reference;                     //!< at the points
    std::vector<ReferenceLight> referenceBounces; //!< as RadiosityReference::byBounce; empty unless asked for
    std::vector<std::size_t> referencePatches;
    std::uint32_t referenceLines = 0;
    double referenceImbalance = 0.0; //!< see RadiosityReference::imbalance
    double referenceSeconds = 0.0;   //!< on the clock
    std::vector<VplMethodResult> methods;

    double meanIrradiance() const; //!< of the reference, over points and channels
};

/// Compares methods with patch radiosity at the centres of the scene's patches. Results but for the times depend on nothing but
/// scene, options and seeds. Throws InputError if the scene has no light, SystemError, Cancelled.
VplComparison compareVpl(const MeshedScene& scene, const RadiosityReference& reference,
                         const VplComparisonOptions& options, Progress& progress);

} // namespace lambert
