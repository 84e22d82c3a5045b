/// Closed-form matrices on one thread, in processor time: a closed cube, and one with a floating box inside; the same sheared,
/// turned, and with a strip of one wall pushed in. Counters: nanoseconds per ordered pair, how far rows are from 1 (RMS), and
/// how far the matrix is from reciprocal (worst, of the larger factor).
///
/// The argument is the number of quads along an edge of the cube; the box has half as many.

#include "core/parallel.h"
#include "formfactors/closed_form_method.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "tests/scene/grid_scene.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

namespace lambert {
namespace {

void quality(const FormFactorMatrix& matrix, const PatchMesh& mesh, benchmark::State& state) {
    const std::size_t n = matrix.size();
    std::vector<double> exchange(n * n, 0.0);
    double squares = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        double sum = matrix.back(i);
        matrix.visit(i, [&](std::uint32_t j, double value) {
            sum += value;
            exchange[i * n + j] = value * static_cast<double>(mesh.area[i]);
        });
        squares += (sum - 1.0) * (sum - 1.0);
    }
    double worst = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double a = exchange[i * n + j], b = exchange[j * n + i];
            if (std::max(a, b) > 1e-12) worst = std::max(worst, std::abs(a - b) / std::max(a, b));
        }
    }
    state.counters["row error"] = std::sqrt(squares / static_cast<double>(n));
    state.counters["reciprocity"] = worst;
}

void closedForm(benchmark::State& state, const GridScene::Map& map, bool withBox) {
    const int n = static_cast<int>(state.range(0));
    GridScene grids;
    grids.box({0, 0, 0}, {1, 1, 1}, n, true, map);
    if (withBox) grids.box({0.35, 0.3, 0.4}, {0.65, 0.6, 0.7}, n / 2, false, map);
    const Scene scene = prepareScene(grids.scene());
    const RayCaster rays(scene);
    Progress progress;
    MeshOptions options;
    options.patches = 0;
    const PatchMesh mesh = buildPatchMesh(scene, options, progress);
    setThreadCount(1);
    FormFactorMatrix matrix;
    for (auto _ : state) matrix = computeMatrix(ClosedForm(mesh, rays, {}), MatrixStorage::Double, progress);
    setThreadCount(0);
    quality(matrix, mesh, state);
    state.counters["patches"] = static_cast<double>(mesh.size());
    state.counters["pairs/s"] = benchmark::Counter(static_cast<double>(mesh.size() * mesh.size()),
                                                   benchmark::Counter::kIsIterationInvariantRate);
}

#define LAMBERT_CLOSED_FORM(name, map)                                                                                 \
    BENCHMARK_CAPTURE(closedForm, cube_##name, map, false)->Arg(12)->Arg(24)->Unit(benchmark::kMillisecond);           \
    BENCHMARK_CAPTURE(closedForm, box_##name, map, true)->Arg(8)->Arg(16)->Unit(benchmark::kMillisecond)

LAMBERT_CLOSED_FORM(plain, same);
LAMBERT_CLOSED_FORM(sheared, sheared);
LAMBERT_CLOSED_FORM(turned, turned);
LAMBERT_CLOSED_FORM(dented, dented);

} // namespace
} // namespace lambert
