#include "solver/emitter_light.h"

#include "core/parallel.h"
#include "core/random.h"
#include "core/sample_points.h"
#include "formfactors/patch_sampling.h"
#include "meshing/patch_offset.h"
#include "solver/emitter_receiver.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace lambert {

namespace {

constexpr std::uint32_t kPatchPoints = 16; ///< of one batch
constexpr std::uint32_t kPatchRays = 16;   ///< of one point
constexpr int kMostBatches = 4;
constexpr std::size_t kManyPatches = 30'000; ///< of so many each takes one batch, to bound the time
constexpr int kPointBatches = 8;
constexpr double kPatchError = 3e-3; ///< relative, of a patch's mean: no more batches
constexpr double kEven = 0.1;        ///< relative: points of a patch that vary less, and all see the same, are enough

std::uint64_t keyOf(std::uint32_t index, std::uint32_t kind, std::uint64_t seed, std::uint32_t round = 0) {
    return randomKey({index, round, 0, kind}, seed);
}

/// The mean of batches, and what it may be off by.
class BatchStatistics {
public:
    void add(const RgbSum& batch) {
        ++count_;
        sum_ += batch;
        squares_ += batch * batch;
    }
    RgbSum mean() const { return sum_ / static_cast<double>(count_); }
    RgbSum standardError() const {
        if (count_ < 2) return RgbSum(0.0);
        const double n = count_;
        return glm::sqrt(glm::max(squares_ / n - mean() * mean(), RgbSum(0.0)) / (n - 1.0));
    }
    /// Larger, as few batches may agree by chance.
    RgbSum carefulError() const { return (1.0 + 2.0 / ((count_ - 1.0) * (count_ - 1.0))) * standardError(); }
    int count() const { return count_; }

private:
    int count_ = 0;
    RgbSum sum_{0.0}, squares_{0.0};
};

ReceiverPlane planeOf(const PatchMesh& mesh, std::size_t patch) {
    ReceiverPlane plane{glm::dvec3(mesh.centroid[patch]), glm::dvec3(mesh.normal[patch]), 0.0};
    for (int k = 0; k < mesh.cornerCount(patch); ++k)
        plane.radius = std::max(plane.radius, glm::distance(glm::dvec3(mesh.position(patch, k)), plane.centre));
    return plane;
}

} // namespace

EmitterLight::EmitterLight(const RayCaster& rays, const PatchMesh& mesh, const PatchOptics& optics, std::uint64_t seed)
    : rays_(rays), seed_(seed), tree_(rays, mesh, optics) {}

std::vector<RgbSum> EmitterLight::irradiance(const PatchMesh& mesh, Progress& progress,
                                             std::vector<std::vector<RgbSum>>* byMaterial) const {
    std::vector<RgbSum> result(mesh.size(), RgbSum(0.0));
    const std::size_t groups = materials().size();
    if (byMaterial) byMaterial->assign(groups, result);
    if (empty()) return result;
    const int mostBatches = mesh.size() > kManyPatches ? 1 : kMostBatches;
    const auto ofPatch = [&](std::size_t patch, std::vector<RgbSum>& sums) {
        if (mesh.isHidden(patch)) return;
        const std::uint64_t key = keyOf(static_cast<std::uint32_t>(patch), 0x454D4950, seed_);
        EmitterReceiver receiver(tree_, rays_, planeOf(mesh, patch), patchOriginOffset(rays_, mesh, patch), key);
        if (receiver.isDark()) return;
        const PatchPoints surface(mesh, patch);
        const SamplePoints samples(Sampler::Sobol, kPatchPoints * kMostBatches, 2, key);
        BatchStatistics batches;
        double squares = 0.0;
        std::vector<RgbSum> batch(groups);
        const auto enough = [&] {
            const double mean = sumOf(batches.mean());
            if (batches.count() == mostBatches) return true;
            if (batches.count() > 1) return sumOf(batches.carefulError()) <= kPatchError * mean;
            const double variance = squares / kPatchPoints - mean * mean;
            return !receiver.seesParts() && variance <= kEven * kEven * mean * mean;
        };
        do {
            const std::uint32_t first = static_cast<std::uint32_t>(batches.count()) * kPatchPoints;
            std::fill(batch.begin(), batch.end(), RgbSum(0.0));
            RgbSum before(0.0);
            for (std::uint32_t k = first; k < first + kPatchPoints; ++k) {
                receiver.gather(surface.at({samples.at(k, 0), samples.at(k, 1)}), kPatchRays, 1.0, batch);
                RgbSum now(0.0);
                for (const RgbSum& e : batch) now += e;
                squares += sumOf(now - before) * sumOf(now - before);
                before = now;
            }
            for (std::size_t g = 0; g < groups; ++g) sums[g] += batch[g];
            batches.add(before / static_cast<double>(kPatchPoints));
        } while (!enough());
        // A channel may come out below 0 where little is seen of many colours.
        for (RgbSum& e : sums) e = glm::max(e / (static_cast<double>(batches.count()) * kPatchPoints), RgbSum(0.0));
    };
    progress.begin("light of emitters", mesh.size());
    parallelFor(mesh.size(), 16, [&](std::size_t begin, std::size_t end, int) {
        std::vector<RgbSum> sums(groups);
        for (std::size_t i = begin; i < end; ++i) {
            std::fill(sums.begin(), sums.end(), RgbSum(0.0));
            ofPatch(i, sums);
            for (std::size_t g = 0; g < groups; ++g) {
                result[i] += sums[g];
                if (byMaterial) (*byMaterial)[g][i] = sums[g];
            }
        }
        progress.advance(end - begin);
    });
    progress.end();
    return result;
}

EstimatedLight EmitterLight::irradiance(const glm::vec3& point, const glm::vec3& normal, float lift,
                                        std::uint32_t index, std::uint32_t rays, std::uint32_t round) const {
    if (empty()) return {};
    EmitterReceiver receiver(tree_, rays_, {glm::dvec3(point), glm::dvec3(normal), 0.0}, lift,
                             keyOf(index, 0x454D4954, seed_, round));
    if (receiver.isDark()) return {};
    BatchStatistics batches;
    std::vector<RgbSum> sums(materials().size());
    for (int k = 0; k < kPointBatches; ++k) {
        std::fill(sums.begin(), sums.end(), RgbSum(0.0));
        receiver.gather(point, std::max(rays / kPointBatches, 8U), 1.0, sums);
        RgbSum batch(0.0);
        for (const RgbSum& e : sums) batch += e;
        batches.add(batch);
    }
    return {glm::max(batches.mean(), RgbSum(0.0)), batches.standardError()};
}

} // namespace lambert
