/// Reading OBJ files of 100 MB and 1 GB with normals and texture coordinates, plain and with a texture: bytes per second,
/// and the process's peak memory as a multiple of the file's size. The peak is that of the whole process, so name one
/// benchmark at a time (--benchmark_filter=ReadObj/plain/1000) to measure memory.

#include "core/process.h"
#include "scene/reading/scene_reader.h"

#include <benchmark/benchmark.h>
#include <fmt/os.h>

#include <cmath>
#include <filesystem>
#include <string>

#include <unistd.h>

namespace lambert {
namespace {

/// A hilly landscape of two triangles per cell; the folder is removed with it.
class Landscape {
public:
    Landscape(std::size_t megabytes, bool textured)
        : folder_(std::filesystem::temp_directory_path() / fmt::format("lambert_obj_benchmark_{}", ::getpid())) {
        std::filesystem::create_directories(folder_);
        fmt::output_file((folder_ / "texture.ppm").string()).print("P3 2 1 255 200 100 50 50 100 200\n");
        fmt::output_file((folder_ / "landscape.mtl").string())
            .print("newmtl ground\nKd 0.5 0.5 0.5\n{}", textured ? "map_Kd texture.ppm\n" : "");
        writeObj(megabytes);
    }
    ~Landscape() { std::filesystem::remove_all(folder_); }
    Landscape(const Landscape&) = delete;
    Landscape& operator=(const Landscape&) = delete;

    std::filesystem::path path() const { return folder_ / "landscape.obj"; }

private:
    void writeObj(std::size_t megabytes) const {
        constexpr double kBytesPerVertex = 200.0; // with its two triangles; measured at 100 MB
        const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(megabytes) * 1e6 / kBytesPerVertex));
        auto out = fmt::output_file(path().string());
        out.print("mtllib landscape.mtl\no landscape\n");
        for (std::size_t y = 0; y < side; ++y)
            for (std::size_t x = 0; x < side; ++x) {
                const double u = static_cast<double>(x) / static_cast<double>(side);
                const double v = static_cast<double>(y) / static_cast<double>(side);
                out.print("v {:.6f} {:.6f} {:.6f}\nvt {:.6f} {:.6f}\nvn {:.4f} {:.4f} {:.4f}\n", 100.0 * u, 100.0 * v,
                          std::sin(9.0 * u) * std::cos(7.0 * v), u, v, -0.6 * u, 0.8 * v, 1.0 - u * v);
            }
        out.print("usemtl ground\ns 1\n");
        for (std::size_t y = 0; y + 1 < side; ++y)
            for (std::size_t x = 0; x + 1 < side; ++x) {
                const std::size_t a = y * side + x + 1;
                const std::size_t b = a + side;
                out.print("f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\nf {0}/{0}/{0} {2}/{2}/{2} {3}/{3}/{3}\n", a, a + 1,
                          b + 1, b);
            }
    }

    std::filesystem::path folder_;
};

void readObjFile(benchmark::State& state, bool textured) {
    const Landscape landscape(static_cast<std::size_t>(state.range(0)), textured);
    const auto bytes = static_cast<double>(std::filesystem::file_size(landscape.path()));
    for (auto _ : state) benchmark::DoNotOptimize(readScene(landscape.path()).scene.polygons.size());
    state.SetBytesProcessed(static_cast<std::int64_t>(bytes) * state.iterations());
    state.counters["peak/file"] = static_cast<double>(peakMemoryBytes()) / bytes;
}

BENCHMARK_CAPTURE(readObjFile, plain, false)->Name("ReadObj/plain")->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(readObjFile, textured, true)
    ->Name("ReadObj/textured")
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace lambert
