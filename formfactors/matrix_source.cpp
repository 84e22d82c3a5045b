#include "formfactors/matrix_source.h"

#include "core/checksum.h"
#include "core/error.h"
#include "formfactors/matrix_file.h"
#include "formfactors/matrix_quality.h"

#include <fmt/format.h>

#include <cmath>

namespace lambert {

namespace {

constexpr double kAreaTolerance = 1e-3;    ///< relative; files with few digits
constexpr double kClosureTolerance = 0.01; ///< of a row that is taken from a file
constexpr double kRepairBytes = 60.0;      ///< per factor, while repair() works

void addMaterial(Checksum& sum, const Material& material) {
    sum.add(std::as_bytes(std::span(&material.reflectance, 1)));
    sum.add(std::as_bytes(std::span(&material.emittedRadiance, 1)));
    sum.add(std::uint64_t{material.occluder});
    sum.add(std::uint64_t{material.opacityTexture.texture});
    sum.add(static_cast<std::uint64_t>(std::lround(1e6F * material.opacityCutoff)));
}

/// Throws InputError.
void requireClosure(const FormFactorMatrix& matrix, const std::filesystem::path& path) {
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        const double sum = matrix.row(i).sum();
        if (!(std::abs(sum - 1.0) <= kClosureTolerance))
            throw InputError(
                fmt::format("{}: row {} and its F_back and F_out sum to {:.6g}, not to 1", path.string(), i + 1, sum));
    }
}

/// Repair works on more than the matrix.
void requireRoomForRepair(const FormFactorMatrix& matrix, const TransportOptions& transport) {
    const double bytes = kRepairBytes * static_cast<double>(matrix.entryCount()) + static_cast<double>(matrix.bytes());
    if (bytes <= static_cast<double>(transport.memoryLimit)) return;
    throw SystemError(fmt::format("--repair: {} factors take about {:.2g} GiB while they are repaired, --memory-limit "
                                  "allows {:.2g}; take fewer patches",
                                  matrix.entryCount(), bytes / 1073741824.0,
                                  static_cast<double>(transport.memoryLimit) / 1073741824.0));
}

} // namespace

std::uint64_t sceneChecksum(const PatchMesh& mesh, const Scene& scene) {
    Checksum sum;
    sum.add(scene.positions);
    for (const Polygon& polygon : scene.polygons) {
        sum.add(std::as_bytes(std::span(polygon.vertices)));
        sum.add(std::uint64_t{polygon.material} << 32 | polygon.backMaterial);
        sum.add(std::uint64_t{polygon.node});
    }
    for (const Material& material : scene.materials) addMaterial(sum, material);
    for (const auto& texture : scene.textures)
        for (int y = 0; y < texture->height(); ++y)
            for (int x = 0; x < texture->width(); ++x)
                sum.add(static_cast<std::uint64_t>(std::lround(1e6F * texture->opacity(x, y))));
    for (const SurfaceCorners& surface : scene.surfaces) sum.add(std::as_bytes(std::span(surface.uv)));
    sum.add(mesh.positions);
    sum.add(mesh.corners);
    sum.add(mesh.area);
    return sum.value();
}

std::string matrixIdentity(const TransportPlan& plan, const PatchMesh& mesh, const Scene& scene,
                           const std::string& version) {
    const TransportOptions& o = plan.options;
    std::string text = fmt::format("lambert {}, {}", version, plan.effort());
    if (hasResolution(o.method)) text += o.randomRotation ? ", random rotation" : ", fixed rotation";
    if (hasLines(o.method)) text += fmt::format(", {}", nameOf(o.sampler));
    return text + fmt::format(", seed {}, {}, {} patches, scene {:016x}", o.seed,
                              o.storage ? nameOf(*o.storage) : "not stored", mesh.size(), sceneChecksum(mesh, scene));
}

FormFactorMatrix readMatrixOf(const PatchMesh& mesh, const std::filesystem::path& path, MatrixStorage storage) {
    PatchMatrix read = readMatrix(path, storage);
    const auto fail = [&](const std::string& what) { throw InputError(fmt::format("{}: {}", path.string(), what)); };
    if (read.matrix.size() != mesh.size())
        fail(fmt::format("found a matrix of {} patches, the scene has {}; mesh options such as --patches must be those "
                         "it was made with",
                         read.matrix.size(), mesh.size()));
    for (std::size_t i = 0; i < read.area.size(); ++i) {
        const auto area = static_cast<double>(mesh.area[i]);
        if (!(std::abs(read.area[i] - area) <= kAreaTolerance * area))
            fail(fmt::format("patch {} has {:.6g} m², in the scene it has {:.6g}: the matrix is of another mesh", i + 1,
                             read.area[i], area));
    }
    return std::move(read.matrix);
}

SceneMatrix obtainMatrix(const MatrixSource& source, const CheckpointOptions& checkpoint, const PatchMesh& mesh,
                         const RayCaster& rays, Progress& progress) {
    SceneMatrix result;
    std::vector<double> weights;
    if (!source.transport.stored) throw UsageError("--storage none: only a solver can do without a matrix");
    if (!source.file.empty()) {
        progress.begin("read form factors", 0);
        result.matrix = readMatrixOf(mesh, source.file, source.transport.storage.value_or(MatrixStorage::Double));
        requireClosure(result.matrix, source.file);
        weights = repairWeights(mesh);
        progress.end();
    } else {
        result.plan = planTransport(source.transport, mesh, rays, progress);
        if (!checkpoint.path.empty())
            result.checkpoint = std::make_unique<MatrixCheckpoint>(
                checkpoint, result.plan->options.method,
                matrixIdentity(*result.plan, mesh, rays.scene(), checkpoint.version));
        TransportMatrix computed = computeMatrix(*result.plan, mesh, rays, progress, result.checkpoint.get());
        result.matrix = std::move(computed.matrix);
        result.plan->rays = computed.rays;
        weights = std::move(computed.repairWeights);
    }
    if (source.repair) {
        requireRoomForRepair(result.matrix, source.transport);
        progress.begin("repair", 0);
        result.deficit = columnDeficit(result.matrix, mesh.area);
        result.repair = repair(result.matrix, mesh.area, weights);
        progress.end();
    }
    return result;
}

} // namespace lambert
