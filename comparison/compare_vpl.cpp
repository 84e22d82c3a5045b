#include "comparison/compare_vpl.h"

#include "comparison/page/figure_text.h"
#include "core/process.h"
#include "core/stopwatch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

using Field = std::vector<RgbSum>;

/// One comparison on its way.
class Run {
public:
    Run(const MeshedScene& scene, const VplComparisonOptions& options, Progress& progress)
        : scene_(scene), options_(options), progress_(progress) {}

    VplComparison operator()(const RadiosityReference& reference) {
        result_.points = patchCentres(scene_.mesh, *scene_.rays, result_.patches);
        options_.onStage("reference at the receivers");
        result_.reference =
            reference.at(result_.points.receivers, result_.points.weight, options_.gathering, progress_);
        if (options_.perBounce) {
            options_.onStage("reference at the receivers, by bounce");
            result_.referenceBounces =
                reference.byBounce(result_.points.receivers, result_.points.weight, options_.gathering, progress_);
        }
        result_.referencePatches = reference.patches();
        result_.referenceLines = reference.lines();
        result_.referenceImbalance = reference.imbalance();
        for (const auto& method : options_.methods) result_.methods.push_back(compared(method));
        return std::move(result_);
    }

private:
    std::uint64_t seed(int k) const { return options_.seed + static_cast<std::uint64_t>(k); }
    VplView view() const { return {result_.points.receivers}; }

    VplMethodResult compared(const std::shared_ptr<const VplMethod>& method) {
        VplMethodResult result;
        result.method = method;
        std::vector<double> efforts = options_.ladder.value_or(method->ladder(options_.effort));
        efforts.push_back(options_.effort);
        std::sort(efforts.begin(), efforts.end());
        efforts.erase(std::unique(efforts.begin(), efforts.end()), efforts.end());
        for (const double effort : efforts) {
            if (effort == options_.effort) result.main = result.ladder.size();
            result.ladder.push_back(rung(*method, effort));
        }
        anatomise(result);
        if (!result_.referenceBounces.empty() && method->knowsBounces()) result.bounces = bounces(*method);
        return result;
    }

    VplRung rung(const VplMethod& method, double effort) {
        VplRung rung;
        rung.effort = effort;
        std::vector<Field> fields;
        for (int k = 0; k < method.seeds(options_.seeds); ++k) {
            options_.onStage(fmt::format("{} {}, seed {} of {}", method.name(), countText(effort), k + 1,
                                         method.seeds(options_.seeds)));
            const Stopwatch watch;
            const double start = processorSeconds();
            MethodLight light = method.light(*scene_.rays, view(), effort, seed(k), progress_);
            VplRun& run = rung.runs.emplace_back();
            run.processorSeconds = processorSeconds() - start;
            run.wallSeconds = watch.seconds();
            run.lights = static_cast<double>(light.lights);
            run.rays = static_cast<double>(light.rays);
            run.errors = lightErrors(result_.points.weight, result_.reference.irradiance, light.irradiance);
            fields.push_back(std::move(light.irradiance));
        }
        rung.sampling = deviation(fields);
        return rung;
    }

    std::vector<VplBounce> bounces(const VplMethod& method) {
        const std::vector<ReferenceLight>& known = result_.referenceBounces;
        std::vector<VplBounce> result(known.size());
        for (int k = 0; k < method.seeds(options_.seeds); ++k) {
            options_.onStage(
                fmt::format("{}, by bounce, seed {} of {}", method.name(), k + 1, method.seeds(options_.seeds)));
            const std::vector<Field> fields =
                method.lightByBounce(*scene_.rays, view(), options_.effort, seed(k),
                                     static_cast<std::uint32_t>(known.size() - 1), progress_);
            for (std::size_t b = 0; b < known.size(); ++b)
                result[b].runs.push_back(lightErrors(result_.points.weight, known[b].irradiance, fields[b]));
        }
        for (std::size_t b = 0; b < known.size(); ++b)
            result[b].significant = result[b].of(&FieldErrors::rms).mean > known[b].rms.total();
        return result;
    }

    /// RMS over points and channels of what one run is off the mean of all, for infinitely many runs.
    double deviation(const std::vector<Field>& fields) const {
        if (fields.size() < 2) return 0.0;
        const auto runs = static_cast<double>(fields.size());
        double sum = 0.0;
        double total = 0.0;
        for (std::size_t i = 0; i < result_.points.weight.size(); ++i) {
            RgbSum mean(0.0);
            for (const Field& field : fields) mean += field[i] / runs;
            for (const Field& field : fields) {
                const RgbSum off = field[i] - mean;
                sum += result_.points.weight[i] * (off.x * off.x + off.y * off.y + off.z * off.z) / (runs - 1.0);
            }
            total += 3.0 * result_.points.weight[i];
        }
        return std::sqrt(sum / total);
    }

    void anatomise(VplMethodResult& result) {
        const VplMethod& method = *result.method;
        std::vector<std::vector<Field>> runs;
        for (int k = 0; k < method.seeds(options_.seeds); ++k) {
            options_.onStage(
                fmt::format("{}, anatomy, seed {} of {}", method.name(), k + 1, method.seeds(options_.seeds)));
            runs.push_back(method.exchanged(*scene_.rays, view(), options_.effort, seed(k), progress_));
        }
        const Approximation sampling{"sampling", fmt::format("{} {}", countText(options_.effort), method.effort().name),
                                     fmt::format("mean over {} runs", runs.size() - 1)};
        result.anatomy = errorAnatomy(result_.points.weight, result_.reference.irradiance,
                                      result_.reference.rms.total(), runs, method.approximations(), sampling);
        result.significant = result.anatomy.rms > result_.reference.rms.total();
        result.partSizes = partSizes(result_.reference.irradiance, runs);
    }

    const MeshedScene& scene_;
    const VplComparisonOptions& options_;
    Progress& progress_;
    VplComparison result_;
};

} // namespace

LightErrors lightErrors(std::span<const double> weight, std::span<const RgbSum> reference,
                        std::span<const RgbSum> light) {
    std::vector<double> weights, all[2], one[3][2];
    for (std::size_t i = 0; i < weight.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            weights.push_back(weight[i]);
            all[0].push_back(reference[i][c]);
            all[1].push_back(light[i][c]);
            one[c][0].push_back(reference[i][c]);
            one[c][1].push_back(light[i][c]);
        }
    }
    LightErrors errors;
    errors.overall = fieldErrors(weights, all[0], all[1]);
    for (std::size_t c = 0; c < 3; ++c) errors.channels[c] = fieldErrors(weight, one[c][0], one[c][1]);
    return errors;
}

MeanDeviation VplRung::of(const std::function<double(const VplRun&)>& value) const {
    std::vector<double> values;
    for (const VplRun& run : runs) values.push_back(value(run));
    return meanDeviation(values);
}

MeanDeviation VplRung::of(double FieldErrors::*value) const {
    return of([value](const VplRun& run) { return run.errors.overall.*value; });
}

MeanDeviation VplBounce::of(double FieldErrors::*value) const {
    std::vector<double> values;
    for (const LightErrors& run : runs) values.push_back(run.overall.*value);
    return meanDeviation(values);
}

double VplComparison::meanIrradiance() const {
    double sum = 0.0;
    double total = 0.0;
    for (std::size_t i = 0; i < points.weight.size(); ++i) {
        const RgbSum& e = reference.irradiance[i];
        sum += points.weight[i] * (e.x + e.y + e.z);
        total += 3.0 * points.weight[i];
    }
    return sum / total;
}

VplComparison compareVpl(const MeshedScene& scene, const RadiosityReference& reference,
                         const VplComparisonOptions& options, Progress& progress) {
    return Run(scene, options, progress)(reference);
}

} // namespace lambert
