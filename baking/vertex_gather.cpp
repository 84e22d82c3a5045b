#include "baking/vertex_gather.h"

#include "baking/vertex_smoothing.h"
#include "core/parallel.h"
#include "formfactors/matrix_quality.h"

#include <glm/exponential.hpp>

#include <array>
#include <numeric>

namespace lambert {

namespace {

constexpr int kMostRounds = 4;
constexpr double kShareOfReflected = 0.5;         ///< of the allowed variance
constexpr std::array kInside{0.25F, 0.5F, 0.75F}; ///< of the way to a patch's centre, tried one after the other

/// What is kept of a vertex between rounds, beside its noisy reflected light.
struct VertexState {
    Rgb direct{0.0F}, directVariance{0.0F}, patchError{0.0F};
    std::uint32_t directRays = 0;
    std::int8_t inside = -1; ///< into kInside; -1: at the vertex's own places
};

class VertexGather {
public:
    VertexGather(const FinalGather& gather, const VertexPlaces& places, const BakedMesh& mesh)
        : gather_(gather),
          places_(places),
          smoothing_(mesh),
          states_(mesh.positions.size()),
          reflected_(mesh.positions.size()),
          result_(mesh.positions.size()) {}

    std::vector<VertexLight> run(Progress& progress) {
        progress.begin("gather", states_.size());
        parallelFor(states_.size(), 64, [&](std::size_t begin, std::size_t end, int) {
            std::vector<VertexPlace> found;
            for (std::size_t vertex = begin; vertex < end; ++vertex) start(vertex, found);
            progress.advance(end - begin);
        });
        progress.end();
        std::vector<std::uint32_t> open(states_.size());
        std::iota(open.begin(), open.end(), 0U);
        for (int round = 1;; ++round) {
            open = smoothed(open);
            if (open.empty() || round == kMostRounds) break;
            progress.begin("gather more", open.size());
            parallelFor(open.size(), 16, [&](std::size_t begin, std::size_t end, int) {
                std::vector<VertexPlace> found;
                for (std::size_t k = begin; k < end; ++k) refine(open[k], static_cast<std::uint32_t>(round), found);
                progress.advance(end - begin);
            });
            progress.end();
        }
        return std::move(result_);
    }

private:
    std::uint32_t indexOf(std::size_t vertex, std::size_t place) const {
        return static_cast<std::uint32_t>(vertex + place * states_.size());
    }

    void start(std::size_t vertex, std::vector<VertexPlace>& found) {
        places_.of(vertex, found);
        if (found.empty()) return;
        VertexState& state = states_[vertex];
        double covered = begin(vertex, found);
        for (std::size_t k = 0; k < kInside.size() && covered > kCovered; ++k) {
            state.inside = static_cast<std::int8_t>(k);
            covered = begin(vertex, {places_.inside(vertex, kInside[k])});
        }
        if (covered > kCovered) reflected_[vertex].rays = 0;
    }

    /// Returns the share of the hemisphere that is closed by backs.
    double begin(std::size_t vertex, const std::vector<VertexPlace>& found) {
        RgbSum direct(0.0), directVariance(0.0), reflected(0.0), variance(0.0), patchError(0.0);
        double covered = 0.0, directRays = 0.0, rays = 0.0;
        for (std::size_t k = 0; k < found.size(); ++k) {
            const auto& [point, patch, weight] = found[k];
            GatheredLight light = gather_.begin(point, indexOf(vertex, k));
            gather_.refineDirect(point, indexOf(vertex, k), kShareOfReflected, light);
            direct += weight * light.direct();
            directVariance += weight * weight * light.directVariance();
            reflected += weight * light.reflected.mean;
            variance += weight * weight * light.reflected.variance;
            patchError += weight * light.patchError;
            covered += weight * light.covered;
            rays += light.reflected.rays;
            directRays += light.rays() - light.reflected.rays;
        }
        VertexState& state = states_[vertex];
        state.direct = Rgb(direct);
        state.directVariance = Rgb(directVariance);
        state.patchError = Rgb(patchError);
        state.directRays = static_cast<std::uint32_t>(directRays);
        reflected_[vertex] = {Rgb(reflected), Rgb(variance), static_cast<std::uint32_t>(rays)};
        return covered;
    }

    /// One more set of rays to surfaces, four times as many as in the round before.
    void refine(std::uint32_t vertex, std::uint32_t round, std::vector<VertexPlace>& found) {
        VertexState& state = states_[vertex];
        if (state.inside < 0)
            places_.of(vertex, found);
        else
            found.assign(1, places_.inside(vertex, kInside[static_cast<std::size_t>(state.inside)]));
        GatheredLight::Part sum;
        RgbSum mean(0.0), variance(0.0), patchError(0.0);
        double rays = 0.0;
        for (std::size_t k = 0; k < found.size(); ++k) {
            GatheredLight light;
            light.reflected.round = round;
            gather_.refineReflected(found[k].point, indexOf(vertex, k), light);
            mean += found[k].weight * light.reflected.mean;
            variance += found[k].weight * found[k].weight * light.reflected.variance;
            patchError += found[k].weight * light.patchError;
            rays += light.reflected.rays;
        }
        NoisyValue& value = reflected_[vertex];
        sum.mean = RgbSum(value.value);
        sum.variance = RgbSum(value.variance);
        sum.rays = value.rays;
        sum.add(mean, variance, rays);
        value = {Rgb(sum.mean), Rgb(sum.variance), static_cast<std::uint32_t>(sum.rays)};
        state.patchError = Rgb(patchError);
    }

    /// Sets the result of all vertices (those near a refined one see it too); those of `open` that are not good enough yet.
    std::vector<std::uint32_t> smoothed(const std::vector<std::uint32_t>& open) {
        // One for each thread: each is as large as the mesh.
        std::vector<VertexSmoothing::Worker> workers(static_cast<std::size_t>(threadCount()),
                                                     VertexSmoothing::Worker(smoothing_));
        parallelFor(states_.size(), 256, [&](std::size_t begin, std::size_t end, int thread) {
            VertexSmoothing::Worker& worker = workers[static_cast<std::size_t>(thread)];
            for (std::size_t vertex = begin; vertex < end; ++vertex) {
                if (reflected_[vertex].rays == 0) continue;
                const VertexState& state = states_[vertex];
                const SmoothedValue value = worker.at(static_cast<std::uint32_t>(vertex), reflected_);
                const RgbSum variance = value.variance + RgbSum(state.directVariance);
                VertexLight& light = result_[vertex];
                light.irradiance = glm::max(value.value + RgbSum(state.direct), RgbSum(0.0));
                light.standardError = glm::sqrt(variance + RgbSum(state.patchError * state.patchError));
                light.relative = gather_.relative(sumOf(glm::sqrt(variance)), light.irradiance);
                light.rays = reflected_[vertex].rays + state.directRays;
            }
        });
        std::vector<std::uint32_t> left;
        for (const std::uint32_t vertex : open)
            if (result_[vertex].rays > 0 && result_[vertex].relative > gather_.options().error) left.push_back(vertex);
        return left;
    }

    const FinalGather& gather_;
    const VertexPlaces& places_;
    VertexSmoothing smoothing_;
    std::vector<VertexState> states_;
    std::vector<NoisyValue> reflected_;
    std::vector<VertexLight> result_;
};

} // namespace

std::vector<VertexLight> gatherAtVertices(const FinalGather& gather, const VertexPlaces& places, const BakedMesh& mesh,
                                          Progress& progress) {
    return VertexGather(gather, places, mesh).run(progress);
}

} // namespace lambert
