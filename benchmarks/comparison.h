#pragma once

#include "core/parallel.h"
#include "formfactors/form_factor_method.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/patch_optics.h"
#include "meshing/prepare.h"
#include "scene/example_scenes.h"
#include "scene/rays/ray_caster.h"
#include "scene/reading/scene_reader.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <time.h>

namespace lambert {

/// CPU time of this thread: a shared machine's other work does not count.
class CpuStopwatch {
public:
    /// Seconds since the last call, or since the start.
    double lap() {
        const double now = seconds();
        return now - std::exchange(lap_, now);
    }

private:
    static double seconds() {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }
    double lap_ = seconds();
};

/// Two ways to do the same work, measured in turns on one thread, because a shared machine's speed drifts. Medians are
/// those of the turns.
class Comparison {
public:
    Comparison() { setThreadCount(1); }
    ~Comparison() { setThreadCount(0); }
    Comparison(const Comparison&) = delete;
    Comparison& operator=(const Comparison&) = delete;

    /// One turn: seconds in which both did the work of `rays` rays.
    void add(double rays, double bareSeconds, double ourSeconds) {
        bare_.push_back(1e-6 * rays / bareSeconds);
        ours_.push_back(1e-6 * rays / ourSeconds);
        ratio_.push_back(bareSeconds / ourSeconds);
    }

    void report(benchmark::State& state) {
        state.counters["bare_Mrays/s"] = median(bare_);
        state.counters["ours_Mrays/s"] = median(ours_);
        state.counters["ratio"] = median(ratio_);
    }

private:
    static double median(std::vector<double>& values) {
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    }
    std::vector<double> bare_, ours_, ratio_;
};

/// Rows of a method against bare tracing of the same rays, for 24 patches a turn: `raysOf(patch)`, which is not measured,
/// makes what `trace(patch, rays)` traces.
template <typename RaysOf, typename Trace>
void compareRows(benchmark::State& state, const FormFactorMethod& method, RaysOf raysOf, Trace trace) {
    constexpr std::size_t kRows = 24;
    RowAccumulator accumulator(method.patchCount());
    FormFactorRow row;
    Comparison comparison;
    for (auto _ : state) {
        double bareSeconds = 0.0;
        double rowSeconds = 0.0;
        for (std::size_t k = 0; k < kRows; ++k) {
            const auto patch = static_cast<std::uint32_t>(k * method.patchCount() / kRows);
            const auto rays = raysOf(patch);
            CpuStopwatch watch;
            trace(patch, rays);
            bareSeconds += watch.lap();
            method.row(patch, accumulator);
            accumulator.take(row);
            rowSeconds += watch.lap();
        }
        comparison.add(static_cast<double>(kRows * method.raysPerRow()), bareSeconds, rowSeconds);
    }
    comparison.report(state);
}

/// A scene with what traces rays through it and patches.
struct BenchmarkScene {
    BenchmarkScene(const Scene& input, std::size_t patches) : scene(prepareScene(input)), rays(scene) {
        MeshOptions options;
        options.patches = patches;
        Progress progress;
        mesh = buildPatchMesh(scene, options, progress);
        optics = patchOptics(scene, mesh);
    }
    Scene scene;
    RayCaster rays;
    PatchMesh mesh;
    PatchOptics optics;
};

/// Registers a comparison on the closed cube, the table room, the Cornell box, and the staircase if LAMBERT_SCENES has it.
/// `compare(state, scene)` is called with a BenchmarkScene of 5,000 patches or more.
template <typename Compare>
void registerComparison(const std::string& name, int turns, Compare compare) {
    const auto add = [&](const std::string& sceneName, auto makeScene) {
        benchmark::RegisterBenchmark((name + "/" + sceneName).c_str(),
                                     [=](benchmark::State& state) {
                                         const BenchmarkScene scene(makeScene(), 5000);
                                         compare(state, scene);
                                     })
            ->Iterations(turns)
            ->Unit(benchmark::kMillisecond);
    };
    add("closed_cube", [] {
        const Material wall = greyMaterial("wall", 0.5F, 1.0F);
        return boxScene(glm::vec3(1.0F), {wall, wall, wall, wall, wall, wall});
    });
    add("table_room", [] { return readScene(LAMBERT_DATA "/table_room.gltf").scene; });
    add("cornell_box", [] { return readScene(LAMBERT_DATA "/cornell_box.obj").scene; });
    if (const char* folder = std::getenv("LAMBERT_SCENES"); folder != nullptr)
        add("staircase", [folder] { return readScene(fmt::format("{}/staircase/staircase.obj", folder)).scene; });
}

} // namespace lambert
