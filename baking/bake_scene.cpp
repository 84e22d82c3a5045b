#include "baking/bake_scene.h"

#include "core/error.h"
#include "core/stopwatch.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace lambert {

namespace {

constexpr double kBackFaceWarning = 0.01;
/// A patch that sees more backs than this is inside something. (Not all backs: where solids touch, a ray may slip from the
/// inside of one into the other.)
constexpr double kInside = 0.8;
constexpr double kUndividedWarning = 1e-3; ///< of the area

void requireLight(const Scene& scene) {
    const bool lit = std::any_of(scene.polygons.begin(), scene.polygons.end(), [&](const Polygon& polygon) {
        return scene.materials[polygon.material].emittedRadiance != Rgb(0.0F);
    });
    if (lit) return;
    const char* punctual = scene.lights.empty() ? "" : ", and lights without area are not used yet";
    throw InputError(fmt::format(
        "the scene has no light: no material that is used emits{}; give one with --emit MATERIAL=r,g,b", punctual));
}

/// What no material's constants tell: an emission texture may be black.
void requireLight(const PatchMesh& mesh) {
    const auto& emitted = mesh.emittedRadiosity;
    if (std::all_of(emitted.begin(), emitted.end(), [](const Rgb& b) { return b == Rgb(0.0F); }))
        throw InputError("the scene has no light: wherever a material emits, its emission texture is black or has a "
                         "hole; give another light with --emit MATERIAL=r,g,b");
}

/// Entries per row at a resolution, from rows of a few patches spread over the mesh.
double pilotEntriesPerRow(const PatchMesh& mesh, const RayCaster& rays, int resolution) {
    const Hemicube method(mesh, rays, {.resolution = resolution});
    RowAccumulator accumulator(mesh.size());
    FormFactorRow row;
    const std::size_t samples = std::min<std::size_t>(32, mesh.size());
    std::size_t entries = 0;
    for (std::size_t i = 0; i < samples; ++i) {
        method.row(static_cast<std::uint32_t>(i * mesh.size() / samples), accumulator);
        accumulator.take(row);
        entries += row.entries.size();
    }
    return static_cast<double>(entries) / static_cast<double>(samples);
}

int chooseResolution(const PatchMesh& mesh, const RayCaster& rays, const BakeOptions& options) {
    const auto count = static_cast<double>(mesh.size());
    int chosen = 0;
    for (int resolution = options.largestResolution; resolution >= 16; resolution -= 8) {
        chosen = resolution;
        if (3.0 * resolution * resolution * count > options.mostRays) continue;
        const double bytes = count * bytesPerFactor(MatrixStorage::Float) * pilotEntriesPerRow(mesh, rays, resolution);
        if (bytes <= static_cast<double>(options.memoryLimit)) break;
    }
    return chosen;
}

/// What the rays meet that end on backs.
struct BacksMet {
    std::string material;  ///< the most frequent one; empty if there is none
    double unwanted = 1.0; ///< share of these rays that do not end on occluders
};

/// The material whose black back is met most by rays from the patches that meet most of them.
BacksMet mostMetBack(const PatchMesh& mesh, const RayCaster& rays, const FormFactorMatrix& matrix) {
    std::vector<std::uint32_t> patches(mesh.size());
    std::iota(patches.begin(), patches.end(), 0U);
    const auto loss = [&](std::uint32_t patch) {
        const double back = matrix.back(patch);
        return back < kInside ? static_cast<double>(mesh.area[patch]) * back : 0.0;
    };
    std::stable_sort(patches.begin(), patches.end(), [&](auto a, auto b) { return loss(a) > loss(b); });
    patches.resize(std::min<std::size_t>(patches.size(), 200));
    const Scene& scene = rays.scene();
    std::vector<double> met(scene.materials.size(), 0.0);
    double occluded = 0.0;
    constexpr int kResolution = 16;
    RayPacket packet;
    const Hemicube hemicube(mesh, rays, {.resolution = kResolution, .randomRotation = false});
    for (const std::uint32_t patch : patches) {
        for (const HemicubeFace& face : hemicubeFaces(mesh.normal[patch], 0.0F, kResolution)) {
            for (int row = 0; row < face.rows; row += 4) {
                for (int column = 0; column < face.columns; column += 4) {
                    tileDirections(face, column, row, kResolution, packet);
                    rays.closest(hemicube.viewpoint(patch).origin, packet);
                    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
                        if (packet.polygon[lane] == kNone || packet.facing[lane] < 0.0F) continue;
                        const Polygon& polygon = scene.polygons[packet.polygon[lane]];
                        if (polygon.backMaterial == kNone)
                            (isOccluder(scene, polygon) ? occluded : met[polygon.material]) +=
                                static_cast<double>(mesh.area[patch]);
                    }
                }
            }
        }
    }
    const auto most = std::max_element(met.begin(), met.end());
    if (!(*most > 0.0)) return {{}, 0.0};
    const double onBacks = std::accumulate(met.begin(), met.end(), 0.0);
    return {scene.materials[static_cast<std::size_t>(most - met.begin())].name, onBacks / (onBacks + occluded)};
}

RowQuality assessRows(const PatchMesh& mesh, const RayCaster& rays, const FormFactorMatrix& matrix) {
    RowQuality quality;
    double receivingArea = 0.0;
    double backArea = 0.0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const FormFactorRow row = matrix.row(i);
        quality.largestClosureError = std::max(quality.largestClosureError, std::abs(row.sum() - 1.0));
        if (row.back >= kInside) continue;
        receivingArea += static_cast<double>(mesh.area[i]);
        backArea += static_cast<double>(mesh.area[i]) * row.back;
    }
    quality.entries = matrix.entryCount();
    quality.bytes = matrix.bytes();
    quality.backFaceFraction = receivingArea > 0.0 ? backArea / receivingArea : 0.0;
    if (quality.backFaceFraction > kBackFaceWarning) {
        const BacksMet met = mostMetBack(mesh, rays, matrix);
        quality.backFaceFraction *= met.unwanted;
        quality.backFaceMaterial = met.material;
    }
    return quality;
}

void collectWarnings(BakedScene& result) {
    const auto warn = [&](std::string text) { result.warnings.push_back(std::move(text)); };
    if (const std::size_t lights = result.scene->lights.size(); lights > 0)
        warn(fmt::format("the scene's {} without area (point, spot, directional) {} not used yet: all light is that of "
                         "emitting materials",
                         lights == 1 ? "light" : fmt::format("{} lights", lights), lights == 1 ? "is" : "are"));
    if (result.rows.backFaceFraction > kBackFaceWarning)
        warn(fmt::format(
            "{:.1f} % of the rays meet black back faces, most of them of material \"{}\": turn its polygons, "
            "or make it two-sided (--two-sided, or \"two_sided\" in an overrides file)",
            100.0 * result.rows.backFaceFraction, result.rows.backFaceMaterial));
    // Specks as small as the weld tolerance are no news; where they matter for the picture, they are.
    const double area = std::accumulate(result.mesh.area.begin(), result.mesh.area.end(), 0.0);
    if (result.meshReport.undividedArea > kUndividedWarning * area)
        warn(fmt::format("{} polygons could not be divided cleanly and stay whole ({:.2g} % of the area)",
                         result.meshReport.undividedPolygons, 100.0 * result.meshReport.undividedArea / area));
}

} // namespace

MeshedScene meshUnlitScene(const Scene& scene, const MeshOptions& options, Progress& progress) {
    MeshedScene result;
    const bool keepPolygons = !options.patchLength && options.patches == std::size_t{0};
    progress.begin("mesh", 0);
    result.scene = std::make_shared<Scene>(prepareScene(
        scene, {.joinTriangles = !keepPolygons, .mergeCoincident = !keepPolygons, .addCrossings = !keepPolygons},
        &result.prepareReport));
    if (result.scene->polygons.empty()) throw InputError("the scene has no polygons of any size");
    result.rays = std::make_unique<RayCaster>(*result.scene);
    result.mesh = buildPatchMesh(*result.scene, options, progress, &result.meshReport);
    progress.end();
    return result;
}

MeshedScene meshScene(const Scene& scene, const BakeOptions& options, Progress& progress) {
    requireLight(scene);
    MeshedScene result = meshUnlitScene(scene, options.mesh, progress);
    requireLight(result.mesh);
    result.resolution = options.resolution ? *options.resolution : chooseResolution(result.mesh, *result.rays, options);
    return result;
}

BakedScene bakeScene(const Scene& scene, const BakeOptions& options, Progress& progress) {
    Stopwatch watch;
    BakedScene result{meshScene(scene, options, progress)};
    result.seconds.mesh = watch.lap();

    const Hemicube hemicube(
        result.mesh, *result.rays,
        {.resolution = result.resolution, .randomRotation = options.randomRotation, .seed = options.seed});
    const FormFactorMatrix matrix = computeMatrix(hemicube, MatrixStorage::Float, progress);
    result.rayCount = hemicube.raysPerRow() * result.mesh.size();
    result.rows = assessRows(result.mesh, *result.rays, matrix);
    result.seconds.formFactors = watch.lap();

    result.solution = solveJacobi(result.mesh, matrix, options.jacobi, progress);
    result.seconds.solve = watch.lap();

    progress.begin("bake", 0);
    result.baked =
        reconstructAverage(result.mesh, *result.scene, result.solution, options.reconstruction, &result.separatedFaces);
    progress.end();
    result.seconds.bake = watch.lap();
    collectWarnings(result);
    return result;
}

} // namespace lambert
