#include "library/lambert.h"

#include "baking/bake_scene.h"
#include "baking/exposure.h"
#include "baking/write_baked.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "lighting/quality.h"
#include "scene/reading/changed_scene.h"

#include <fmt/format.h>

#include <atomic>
#include <mutex>

namespace lambert::library {

struct Scene::Content {
    ReadResult read;
};
struct Bake::Content {
    BakedScene baked;
};

namespace {

constexpr double kSteps = 100.0; ///< of a stage, that are told

/// Passes progress on, and stops.
class Told : public Progress {
public:
    explicit Told(const OnProgress& tell) : tell_(tell) {}

private:
    void onBegin(std::string_view stage, std::uint64_t total) override {
        stage_ = stage;
        total_ = total;
        step_ = 0;
        tell(0.0);
    }
    void onAdvance(std::uint64_t done, std::uint64_t total) override {
        if (total == 0) return;
        const double share = static_cast<double>(done) / static_cast<double>(total);
        if (share * kSteps < step_.load()) return;
        step_ = static_cast<int>(share * kSteps) + 1;
        tell(share);
    }
    void onEnd() override { tell(1.0); }

    void tell(double share) {
        const std::lock_guard lock(mutex_);
        if (tell_ && !tell_(stage_, std::min(share, 1.0))) cancel();
    }

    const OnProgress& tell_;
    std::mutex mutex_;
    std::string stage_;
    std::uint64_t total_ = 0;
    std::atomic<int> step_{0};
};

Failure::Kind kindOf(ExitCode code) {
    switch (code) {
    case ExitCode::Usage:
        return Failure::Kind::Setting;
    case ExitCode::System:
        return Failure::Kind::System;
    case ExitCode::Interrupted:
        return Failure::Kind::Stopped;
    default:
        return Failure::Kind::Input;
    }
}

template <typename Work>
auto failing(const Work& work) {
    try {
        return work();
    } catch (const Error& error) {
        throw Failure(kindOf(error.exitCode()), error.what());
    }
}

SolveOptions optionsOf(const BakeSettings& settings) {
    if (settings.threads < 0) throw UsageError(fmt::format("threads: {}: must be 0 or more", settings.threads));
    SolveOptions options = solveOptions(qualityOf(settings.quality), settings.seed);
    options.mesh.patches = settings.patches;
    return options;
}

std::span<const float> flat(const std::vector<glm::vec3>& values) {
    return {reinterpret_cast<const float*>(values.data()), 3 * values.size()};
}

} // namespace

std::string_view version() { return LAMBERT_VERSION; }

std::size_t Scene::polygons() const { return content_->read.scene.polygons.size(); }

std::vector<std::string> Scene::materials() const {
    std::vector<std::string> names;
    for (const Material& material : content_->read.scene.materials) names.push_back(material.name);
    return names;
}

const std::vector<std::string>& Scene::warnings() const { return content_->read.report.warnings; }

Scene readScene(const std::filesystem::path& path, const ReadSettings& settings) {
    return failing([&] {
        const SceneChanges changes{
            .noOverrides = !settings.overrides, .metresPerUnit = settings.metresPerUnit, .twoSided = settings.twoSided};
        return Scene(std::make_shared<Scene::Content>(Scene::Content{readChangedScene(path, changes)}));
    });
}

std::span<const float> Bake::positions() const { return flat(content_->baked.baked.positions); }
std::span<const float> Bake::normals() const { return flat(content_->baked.baked.normals); }
std::span<const float> Bake::radiosity() const { return flat(content_->baked.baked.radiosity); }
std::span<const float> Bake::irradiance() const { return flat(content_->baked.baked.irradiance); }

std::span<const std::uint32_t> Bake::faces() const {
    const auto& faces = content_->baked.baked.faces;
    return {reinterpret_cast<const std::uint32_t*>(faces.data()), 4 * faces.size()};
}

std::vector<double> Bake::origin() const {
    const glm::dvec3& o = content_->baked.baked.origin;
    return {o.x, o.y, o.z};
}

double Bake::imbalance() const { return content_->baked.energyCheck.judged; }
const std::vector<std::string>& Bake::warnings() const { return content_->baked.warnings; }

Bake bake(const Scene& scene, const BakeSettings& settings) {
    return failing([&] {
        Told progress(settings.progress);
        BakeOptions options{.solve = optionsOf(settings)};
        const ThreadCountScope threads(settings.threads);
        options.reconstruction.keepHidden = settings.patches == std::size_t{0}; // the caller's mesh
        return Bake(
            std::make_shared<Bake::Content>(Bake::Content{bakeScene(scene.content().read.scene, options, progress)}));
    });
}

void write(const Bake& bake, const std::filesystem::path& path) {
    failing([&] {
        const std::optional<BakedFormat> format = formatOf(path);
        if (!format) throw UsageError(fmt::format("{}: the name must end in .glb, .gltf, .ply or .obj", path.string()));
        const BakedMesh& mesh = bake.content().baked.baked;
        writeBaked(mesh, path, *format,
                   {Quantity::Radiosity, automaticExposure(mesh, Quantity::Radiosity), LAMBERT_VERSION});
    });
}

FormFactors formFactors(const Scene& scene, const BakeSettings& settings) {
    return failing([&] {
        Told progress(settings.progress);
        const SolveOptions options = optionsOf(settings);
        const ThreadCountScope threads(settings.threads);
        const MeshedScene meshed = meshScene(scene.content().read.scene, options.mesh, progress);
        const FormFactorMatrix matrix =
            obtainMatrix(std::get<FormFactorLight>(options.method).formFactors, {}, meshed.mesh, *meshed.rays, progress)
                .matrix;
        FormFactors result;
        result.row.push_back(0);
        for (std::size_t i = 0; i < matrix.size(); ++i) {
            matrix.visit(i, [&](std::uint32_t j, double factor) {
                result.column.push_back(j);
                result.value.push_back(factor);
            });
            result.row.push_back(result.column.size());
            result.back.push_back(matrix.back(i));
            result.out.push_back(matrix.out(i));
            result.error.push_back(static_cast<double>(matrix.error(i)));
        }
        result.area.assign(meshed.mesh.area.begin(), meshed.mesh.area.end());
        result.material = meshed.mesh.material;
        return result;
    });
}

} // namespace lambert::library
