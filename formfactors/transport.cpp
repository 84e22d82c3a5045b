#include "formfactors/transport.h"

#include "core/error.h"
#include "core/named.h"
#include "core/parallel.h"
#include "formfactors/closed_form_method.h"
#include "formfactors/global_lines.h"
#include "formfactors/hemicube.h"
#include "formfactors/hemisphere.h"
#include "formfactors/local_lines.h"
#include "formfactors/matrix_checkpoint.h"
#include "formfactors/visibility_sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

namespace lambert {

namespace {

struct MethodTraits : Named<TransportMethod> {
    bool resolution, lines, rows, pointRows;
};

constexpr std::array kMethods{MethodTraits{{TransportMethod::Auto, "auto"}, false, false, true, true},
                              MethodTraits{{TransportMethod::Hemicube, "hemicube"}, true, false, true, true},
                              MethodTraits{{TransportMethod::Hemisphere, "hemisphere"}, true, false, true, true},
                              MethodTraits{{TransportMethod::LocalLines, "local-lines"}, false, true, true, true},
                              MethodTraits{{TransportMethod::GlobalLines, "global-lines"}, false, true, false, false},
                              MethodTraits{{TransportMethod::ClosedForm, "closed-form"}, false, false, true, true}};

constexpr double kBytesPerRow = 96.0;   ///< beside its factors, with the allocator's
constexpr double kPixelsPerRay = 0.125; ///< rays between pairs in the time of as many of a hemicube's
constexpr double kOverBudget = 2.0;     ///< rows of auto may take so many times the rays
constexpr double kPilotRays = 4e7;      ///< most of the rows that are computed to learn their length

/// The efforts to choose from, largest first: resolutions or lines.
std::vector<std::uint32_t> effortLadder(const TransportOptions& o, std::size_t patches) {
    std::vector<std::uint32_t> ladder;
    const auto largest = static_cast<std::uint32_t>(o.largestResolution);
    switch (o.method) {
    case TransportMethod::Hemicube:
        for (std::uint32_t r = largest; r >= 16; r -= 8) ladder.push_back(r);
        break;
    case TransportMethod::Hemisphere:
        for (auto r = static_cast<std::uint32_t>(1.7320508 * largest) / 4 * 4; r >= 28; r -= 12) ladder.push_back(r);
        break;
    case TransportMethod::LocalLines:
        for (std::uint32_t n = std::bit_floor(3 * largest * largest); n >= 512; n /= 2) ladder.push_back(n);
        break;
    case TransportMethod::GlobalLines: {
        // A line serves several patches, both ways.
        const double lines = std::min(o.mostRays, 3.0 * largest * largest * static_cast<double>(patches)) / 8.0;
        ladder.push_back(std::bit_floor(static_cast<std::uint32_t>(std::clamp(lines, 65536.0, 2e9))));
        break;
    }
    case TransportMethod::Auto:
    case TransportMethod::ClosedForm:
        ladder.push_back(0);
        break;
    }
    return ladder;
}

TransportPlan withEffort(const TransportOptions& options, std::uint32_t effort) {
    TransportPlan plan{options};
    if (hasResolution(options.method) && !options.resolution) plan.options.resolution = static_cast<int>(effort);
    if (hasLines(options.method) && !options.lines) plan.options.lines = effort;
    return plan;
}

/// Entries per row, from rows of a few patches spread over the mesh.
double pilotEntriesPerRow(const FormFactorMethod& method, Progress& progress) {
    const std::size_t count = method.patchCount();
    const auto affordable = static_cast<std::size_t>(kPilotRays / static_cast<double>(method.raysPerRow() + 1));
    const std::size_t samples = std::min(std::clamp<std::size_t>(affordable, 4, 32), count);
    std::vector<RowAccumulator> accumulators(static_cast<std::size_t>(threadCount()), RowAccumulator(count));
    std::vector<std::size_t> entries(samples);
    parallelFor(samples, 1, [&](std::size_t begin, std::size_t end, int worker) {
        RowAccumulator& accumulator = accumulators[static_cast<std::size_t>(worker)];
        FormFactorRow row;
        for (std::size_t k = begin; k < end; ++k) {
            progress.throwIfCancelled();
            method.row(static_cast<std::uint32_t>(k * count / samples), accumulator);
            accumulator.take(row);
            entries[k] = row.entries.size();
        }
    });
    double sum = 0.0;
    for (const std::size_t n : entries) sum += static_cast<double>(n);
    return sum / static_cast<double>(samples);
}

/// The same for any method; an upper bound where rows are not to be had one by one, or take long.
double entriesPerRow(const TransportPlan& plan, const FormFactorMethod* method, std::size_t patches,
                     Progress& progress) {
    const auto count = static_cast<double>(patches);
    if (!method) return std::min(count, 8.0 * static_cast<double>(*plan.options.lines) / count);
    return plan.options.method == TransportMethod::ClosedForm ? count : pilotEntriesPerRow(*method, progress);
}

/// Chooses the storage and predicts its size; whether it fits.
bool planMemory(TransportPlan& plan, double patches, double entriesPerRow) {
    const auto limit = static_cast<double>(plan.options.memoryLimit);
    const auto bytes = [&](MatrixStorage storage) {
        return patches * (entriesPerRow * bytesPerFactor(storage) + kBytesPerRow);
    };
    if (!plan.options.storage)
        plan.options.storage = bytes(MatrixStorage::Float) <= limit ? MatrixStorage::Float : MatrixStorage::Compact;
    plan.bytes = bytes(*plan.options.storage);
    return plan.bytes <= limit;
}

/// All lines, or those that the checkpoint does not hold yet.
void traceLines(const GlobalLines& lines, GlobalLineCounts& counts, Progress& progress, MatrixCheckpoint* checkpoint) {
    if (!checkpoint) return lines.trace(counts, progress);
    StateCheckpoint& file = checkpoint->lines.value();
    const auto state = [&](auto& archive) { counts.keep(archive); };
    file.restore(state);
    checkpoint->restoredLines = counts.lines();
    try {
        lines.trace(counts, progress, [&] { file.offer(state); });
    } catch (const Cancelled&) {
        file.keep(state);
        throw;
    }
}

} // namespace

std::optional<TransportMethod> methodByName(std::string_view name) { return valueNamed(kMethods, name); }
std::string_view nameOf(TransportMethod method) { return rowOf(kMethods, method).name; }
std::vector<std::string> methodNames() { return namesIn(kMethods); }
bool hasResolution(TransportMethod method) { return rowOf(kMethods, method).resolution; }
bool hasLines(TransportMethod method) { return rowOf(kMethods, method).lines; }
bool hasRows(TransportMethod method) { return rowOf(kMethods, method).rows; }
bool hasPointRows(TransportMethod method) { return rowOf(kMethods, method).pointRows; }

std::string TransportPlan::effort() const {
    std::string text(nameOf(options.method));
    if (hasResolution(options.method)) {
        text += fmt::format(", resolution {}", *options.resolution);
        if (options.perPatch > 1) text += fmt::format(", {} per patch", options.perPatch);
    }
    if (hasLines(options.method))
        text +=
            fmt::format(", {} {}{}", *options.lines, options.lineSet == LineSet::Bundles ? "lines in bundles" : "lines",
                        hasRows(options.method) ? " per patch" : "");
    if (options.method == TransportMethod::Auto)
        text += fmt::format(", error {:g} per row, {} rays at most", options.rowError, options.mostRaysPerRow);
    if (options.method == TransportMethod::ClosedForm) text += fmt::format(", error {:g}", options.error);
    return text;
}

void checkTransport(const TransportOptions& o) {
    const auto refuse = [](const char* option, auto found, const char* allowed) {
        throw UsageError(fmt::format("{}: found {}, allowed are {}", option, found, allowed));
    };
    if (hasResolution(o.method) && o.resolution) {
        const bool cube = o.method == TransportMethod::Hemicube;
        if (cube && (*o.resolution < 4 || *o.resolution > 4096 || *o.resolution % 2 != 0))
            refuse("--resolution", *o.resolution, "even numbers from 4 to 4096");
        if (!cube && (*o.resolution < 4 || *o.resolution > 4096 || *o.resolution % 4 != 0))
            refuse("--resolution", *o.resolution, "multiples of 4 from 4 to 4096 for hemispheres");
    }
    if (o.method == TransportMethod::LocalLines && o.lines && (*o.lines < 1 || *o.lines > 1U << 24))
        refuse("--lines", *o.lines, "1 to 16777216 per patch");
    if (!(o.rowError >= 1e-5 && o.rowError <= 0.5)) refuse("--form-factor-error", o.rowError, "1e-5 to 0.5");
    if (!(o.error >= 1e-8 && o.error <= 0.1)) refuse("--form-factor-error", o.error, "1e-8 to 0.1");
    if (!o.stored && !hasRows(o.method))
        throw UsageError(fmt::format("--storage none: {} computes no single rows", nameOf(o.method)));
    if (o.perPatch < 1 || o.perPatch > 1024) refuse("--hemicubes", o.perPatch, "1 to 1024");
}

TransportPlan planTransport(const TransportOptions& options, const PatchMesh& mesh, const RayCaster& rays,
                            Progress& progress) {
    checkTransport(options);
    const auto patches = static_cast<double>(mesh.size());
    const bool given = hasResolution(options.method) ? options.resolution.has_value() : options.lines.has_value();
    const std::vector<std::uint32_t> ladder =
        given ? std::vector<std::uint32_t>{0} : effortLadder(options, mesh.size());
    for (const std::uint32_t effort : ladder) {
        TransportPlan plan = withEffort(options, effort);
        if (options.method == TransportMethod::Auto)
            plan.options.mostRaysPerRow =
                static_cast<std::uint32_t>(std::clamp(options.mostRays * kPixelsPerRay / patches, 4096.0, 16777216.0));
        const auto method = hasRows(options.method) ? makeMethod(plan, mesh, rays) : nullptr;
        if (options.method == TransportMethod::Auto) pilotEntriesPerRow(*method, progress); // rows differ
        plan.rays = method ? method->raysPerRow() * mesh.size() : *plan.options.lines;
        if (options.method == TransportMethod::Auto &&
            static_cast<double>(plan.rays) > kOverBudget * kPixelsPerRay * options.mostRays) {
            TransportOptions lines = options; // pairs grow with the square of the patches
            lines.method = TransportMethod::LocalLines;
            return planTransport(lines, mesh, rays, progress);
        }
        const bool last = effort == ladder.back();
        if (!last && static_cast<double>(plan.rays) > options.mostRays) continue;
        if (!options.stored) return plan;
        // A dense matrix as float, or as asked for, needs no closer look.
        if (planMemory(plan, patches, patches) && (options.storage || plan.options.storage == MatrixStorage::Float))
            return plan;
        plan.options.storage = options.storage;
        if (planMemory(plan, patches, entriesPerRow(plan, method.get(), mesh.size(), progress))) return plan;
        if (last)
            throw SystemError(fmt::format(
                "the form factors of {} patches would take about {:.2g} GiB ({}), --memory-limit allows {:.2g}; allow "
                "more, or take fewer patches{} or --storage compact{}",
                mesh.size(), plan.bytes / 1073741824.0, plan.effort(),
                static_cast<double>(options.memoryLimit) / 1073741824.0,
                hasLines(options.method) ? ", fewer --lines" : ", a lower --resolution",
                hasRows(options.method) ? "; `bake` also does without them (--solver southwell --storage none)" : ""));
    }
    throw UsageError("no effort to choose from"); // not reached: the last one returns or throws
}

namespace {

std::unique_ptr<FormFactorMethod> makeOpenMethod(const TransportPlan& plan, const PatchMesh& mesh,
                                                 const RayCaster& rays) {
    const TransportOptions& o = plan.options;
    const auto views = [&o] { return ViewOptions{o.resolution.value(), o.perPatch, o.randomRotation, o.seed}; };
    switch (o.method) {
    case TransportMethod::Hemicube:
        return std::make_unique<Hemicube>(mesh, rays, views());
    case TransportMethod::Hemisphere:
        return std::make_unique<Hemisphere>(mesh, rays, views());
    case TransportMethod::LocalLines:
        return std::make_unique<LocalLines>(mesh, rays, LocalLinesOptions{o.lines.value(), o.sampler, o.seed});
    case TransportMethod::Auto:
        return std::make_unique<VisibilitySampling>(mesh, rays,
                                                    VisibilitySamplingOptions{o.rowError, o.mostRaysPerRow, o.seed});
    case TransportMethod::ClosedForm:
        return std::make_unique<ClosedForm>(mesh, rays, ClosedFormOptions{o.error});
    case TransportMethod::GlobalLines:
        break;
    }
    throw UsageError("global-lines: computes no single rows");
}

/// Another method, but for the rows of hidden patches.
class WithHiddenPatches : public FormFactorMethod {
public:
    WithHiddenPatches(std::unique_ptr<FormFactorMethod> method, const PatchMesh& mesh)
        : method_(std::move(method)), mesh_(mesh) {}

    void row(std::uint32_t patch, RowAccumulator& accumulator) const override {
        if (mesh_.isHidden(patch))
            accumulator.add(accumulator.back(), 1.0);
        else
            method_->row(patch, accumulator);
    }
    void pointRow(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index,
                  RowAccumulator& accumulator) const override {
        method_->pointRow(origin, normal, index, accumulator);
    }
    std::size_t patchCount() const override { return method_->patchCount(); }
    std::uint64_t raysPerRow() const override { return method_->raysPerRow(); }
    std::uint64_t raysTraced() const override { return method_->raysTraced(); }

private:
    std::unique_ptr<FormFactorMethod> method_;
    const PatchMesh& mesh_;
};

} // namespace

std::unique_ptr<FormFactorMethod> makeMethod(const TransportPlan& plan, const PatchMesh& mesh, const RayCaster& rays) {
    auto method = makeOpenMethod(plan, mesh, rays);
    if (mesh.hidden.empty()) return method;
    return std::make_unique<WithHiddenPatches>(std::move(method), mesh);
}

TransportMatrix computeMatrix(const TransportPlan& plan, const PatchMesh& mesh, const RayCaster& rays,
                              Progress& progress, MatrixCheckpoint* checkpoint) {
    const TransportOptions& o = plan.options;
    const MatrixStorage storage = o.storage.value();
    if (hasRows(o.method)) {
        MatrixJournal* const journal = checkpoint ? &checkpoint->rows.value() : nullptr;
        const auto method = makeMethod(plan, mesh, rays);
        FormFactorMatrix matrix = computeMatrix(*method, storage, progress, journal);
        return {std::move(matrix), repairWeights(mesh), method->raysTraced() > 0 ? method->raysTraced() : plan.rays};
    }
    const LineCaster caster(rays.scene());
    GlobalLineOptions options{.lines = o.lines.value(), .set = o.lineSet, .sampler = o.sampler, .seed = o.seed};
    GlobalLineCounts counts(mesh.size());
    traceLines(GlobalLines(mesh, caster, options), counts, progress, checkpoint);
    FormFactorMatrix matrix = counts.matrix(storage, progress);
    for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
        if (!mesh.isHidden(patch)) continue;
        FormFactorRow row;
        row.back = 1.0;
        matrix.setRow(patch, row);
    }
    return {std::move(matrix), counts.repairWeights(mesh.area), plan.rays};
}

std::vector<double> repairWeights(const PatchMesh& mesh) {
    std::vector<double> weights;
    for (const float area : mesh.area) weights.push_back(1.0 / static_cast<double>(area));
    return weights;
}

} // namespace lambert
