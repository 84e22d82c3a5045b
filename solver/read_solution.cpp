#include "core/error.h"
#include "core/text.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"
#include "solver/solution_file.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace lambert {

namespace {

using nlohmann::json;

constexpr const char* kPlace = "/extras/lambert";

/// Halves of a quad, as polygonPoint() needs none: files need not hold convex planar ones.
constexpr std::array<std::array<std::size_t, 3>, 2> kHalves{{{0, 1, 2}, {0, 2, 3}}};

class SolutionReader {
public:
    explicit SolutionReader(const std::filesystem::path& path)
        : file_(path.string()), model_(loadGltfModel(path, {}, &extras_)) {
        if (!extras_.is_object() || !extras_.contains("lambert") || !extras_["lambert"].is_object())
            throw InputError(fmt::format("{}: found a glTF file without extras.lambert: not a solution; bake one "
                                         "with --solution",
                                         file_));
        lambert_ = std::move(extras_["lambert"]);
        if (const std::int64_t format = whole("format"); format != 1)
            failAt("format", std::to_string(format), "1: this is of another version of Lambert");
        for (const gltf::Buffer& buffer : model_.buffers) bytesLeft_ += buffer.size();
    }

    StoredSolution read() {
        StoredSolution result;
        result.origin = {text("scene"), text("method"), text("solver")};
        readMesh(result.meshed.mesh, result.meshed.optics);
        result.meshed.scene = std::make_shared<Scene>(sceneOf(result.meshed.mesh));
        readLight(result);
        readRun(result.solution);
        return result;
    }

private:
    [[noreturn]] void failAt(const std::string& member, const std::string& found, const std::string& allowed) const {
        failAtMember(file_, fmt::format("{}/{}", kPlace, member), found, allowed);
    }

    const json& member(const std::string& name) const {
        const auto found = lambert_.find(name);
        if (found == lambert_.end()) failAt(name, "nothing", "a value");
        return *found;
    }
    bool has(const char* name) const { return lambert_.contains(name); }

    std::string text(const char* name) const {
        const json& value = member(name);
        if (!value.is_string()) failAt(name, oneLine(value.dump(), 60), "a string");
        return oneLine(value.get<std::string>());
    }

    double number(const json& value, const std::string& place) const {
        if (!value.is_number()) failAt(place, oneLine(value.dump(), 60), "a number");
        return value.get<double>();
    }
    std::int64_t whole(const json& value, const std::string& place) const {
        constexpr std::uint64_t kLargest = std::uint64_t{1} << 53; // of JSON numbers
        if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kLargest)
            failAt(place, oneLine(value.dump(), 60), "a whole number of at least 0");
        return value.get<std::int64_t>();
    }
    std::int64_t whole(const char* name) const { return whole(member(name), name); }

    /// Of the scene, which only files of scenes far away name.
    glm::dvec3 origin() const {
        glm::dvec3 result(0.0);
        if (!has("origin")) return result;
        const json& values = member("origin");
        if (!values.is_array() || values.size() != 3) failAt("origin", oneLine(values.dump(), 60), "3 numbers");
        for (int c = 0; c < 3; ++c) result[c] = number(values[static_cast<std::size_t>(c)], "origin");
        return result;
    }

    int index(const json& value, const std::string& place) const {
        const std::int64_t result = whole(value, place);
        return static_cast<int>(std::min<std::int64_t>(result, std::numeric_limits<int>::max()));
    }

    /// An accessor of `count` elements. All arrays together take no more bytes than the file has, so that a small file that
    /// names the same one many times cannot fill the memory.
    GltfAccessor array(const json& value, const std::string& place, GltfAccessor::Use use, std::size_t size,
                       std::optional<std::size_t> count) {
        const int accessor = index(value, place);
        GltfAccessor result(file_, model_, accessor, use, fmt::format("{}/{}", kPlace, place));
        if (count && result.count() != *count)
            failAt(place, fmt::format("accessor {} with {} elements", accessor, result.count()),
                   fmt::format("{} elements", *count));
        if (result.count() > bytesLeft_ / size)
            failAt(place, fmt::format("accessor {} with {} elements", accessor, result.count()),
                   "arrays that together fit into the file");
        bytesLeft_ -= result.count() * size;
        return result;
    }

    std::vector<Rgb> vectors(const json& value, const std::string& place, std::optional<std::size_t> count,
                             float lowest, float highest) {
        const GltfAccessor source = array(value, place, GltfAccessor::Use::Vectors, 12, count);
        std::vector<Rgb> result(source.count());
        for (std::size_t k = 0; k < result.size(); ++k) {
            result[k] = Rgb(source.element(k));
            for (int c = 0; c < 3; ++c) check(result[k][c], lowest, highest, place, k);
        }
        return result;
    }
    std::vector<Rgb> colours(const char* name, float lowest, float highest) {
        return vectors(member(name), name, patches_, lowest, highest);
    }

    std::vector<float> numbers(const char* name, float lowest, float highest) {
        const GltfAccessor source = array(member(name), name, GltfAccessor::Use::Numbers, 4, patches_);
        std::vector<float> result(source.count());
        for (std::size_t k = 0; k < result.size(); ++k) {
            result[k] = source.element(k).x;
            check(result[k], lowest, highest, name, k);
        }
        return result;
    }

    std::vector<std::uint32_t> indices(const char* name, std::size_t count, std::size_t limit, bool noneToo) {
        const GltfAccessor source = array(member(name), name, GltfAccessor::Use::Indices, 4, count);
        std::vector<std::uint32_t> result(source.count());
        for (std::size_t k = 0; k < result.size(); ++k) {
            result[k] = source.index(k);
            if (result[k] >= limit && !(noneToo && result[k] == kNone))
                failAt(name, fmt::format("{} as element {}", result[k], k), fmt::format("indices below {}", limit));
        }
        return result;
    }

    void check(float value, float lowest, float highest, const std::string& place, std::size_t k) const {
        if (!(value >= lowest && value <= highest))
            failAt(place, fmt::format("{} as element {}", value, k), fmt::format("{} to {}", lowest, highest));
    }

    void readMesh(PatchMesh& mesh, PatchOptics& optics) {
        patches_ = static_cast<std::size_t>(whole("patches"));
        mesh.frontCount = static_cast<std::size_t>(whole("front_patches"));
        if (patches_ < 1 || patches_ >= kNone / 4) failAt("patches", std::to_string(patches_), "1 to 1073741822");
        if (mesh.frontCount > patches_ || patches_ - mesh.frontCount > mesh.frontCount)
            failAt("front_patches", std::to_string(mesh.frontCount), "half the number of patches to all of them");
        mesh.positions = vectors(member("positions"), "positions", std::nullopt, -kFarthest, kFarthest);
        readCorners(mesh);
        mesh.material = indices("material", patches_, model_.materials.size(), false);
        mesh.area = numbers("area", std::numeric_limits<float>::denorm_min(), kMost);
        if (has("opacity")) mesh.opacity = numbers("opacity", 0.0F, 1.0F);
        optics.reflectance = colours("reflectance", 0.0F, 1.0F);
        optics.emittedRadiosity = colours("emitted_radiosity", 0.0F, kMost);
        setGeometry(mesh);
    }

    void readCorners(PatchMesh& mesh) {
        const std::vector<std::uint32_t> flat = indices("corners", 4 * patches_, mesh.positions.size(), true);
        mesh.corners.resize(patches_);
        for (std::size_t patch = 0; patch < patches_; ++patch)
            for (std::size_t k = 0; k < 4; ++k) {
                mesh.corners[patch][k] = flat[4 * patch + k];
                if (k < 3 && flat[4 * patch + k] == kNone)
                    failAt("corners", fmt::format("no corner as element {}", 4 * patch + k),
                           "that only as the fourth of a patch");
            }
        fronts_.assign(patches_ - mesh.frontCount, kNone);
        if (!fronts_.empty()) fronts_ = indices("fronts", fronts_.size(), mesh.frontCount, true);
    }

    static void setGeometry(PatchMesh& mesh) {
        for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
            glm::dvec3 sum(0.0), weighted(0.0), middle(0.0);
            for (int k = 0; k < mesh.cornerCount(patch); ++k)
                middle += glm::dvec3(mesh.position(patch, k)) / static_cast<double>(mesh.cornerCount(patch));
            double weights = 0.0;
            for (std::size_t half = 0; half < (mesh.isQuad(patch) ? 2U : 1U); ++half) {
                const auto at = [&](std::size_t k) {
                    return glm::dvec3(mesh.position(patch, static_cast<int>(kHalves[half][k])));
                };
                const glm::dvec3 twice = glm::cross(at(1) - at(0), at(2) - at(0));
                sum += twice;
                weights += glm::length(twice);
                weighted += glm::length(twice) * (at(0) + at(1) + at(2)) / 3.0;
            }
            const double length = glm::length(sum);
            mesh.normal.emplace_back(length > 0.0 ? glm::vec3(sum / length) : glm::vec3(0.0F, 0.0F, 1.0F));
            mesh.centroid.emplace_back(weights > 0.0 ? weighted / weights : middle);
        }
    }

    /// The scene of the fronts' triangles; the mesh learns to which patches they belong.
    Scene sceneOf(PatchMesh& mesh) const {
        Scene scene;
        scene.origin = origin();
        scene.nodes.emplace_back();
        scene.positions = mesh.positions;
        for (const gltf::Material& material : model_.materials)
            scene.materials.emplace_back().name = oneLine(material.name);
        std::vector<std::uint32_t> backs(mesh.frontCount, kNone);
        for (std::size_t k = 0; k < fronts_.size(); ++k)
            if (fronts_[k] != kNone) backs[fronts_[k]] = static_cast<std::uint32_t>(mesh.frontCount + k);
        mesh.polygon.assign(mesh.size(), kNone);
        for (std::uint32_t patch = 0; patch < mesh.frontCount; ++patch) {
            if (!mesh.opacity.empty() && mesh.opacity[patch] == 0.0F) continue;
            for (std::size_t half = 0; half < (mesh.isQuad(patch) ? 2U : 1U); ++half) {
                Polygon polygon;
                for (std::size_t k = 0; k < 3; ++k) polygon.vertices[k] = mesh.corners[patch][kHalves[half][k]];
                polygon.material = mesh.material[patch];
                if (backs[patch] != kNone) polygon.backMaterial = mesh.material[backs[patch]];
                if (!std::isnormal(static_cast<float>(polygonArea(scene, polygon)))) continue; // no ray meets it
                const auto index = static_cast<std::uint32_t>(scene.polygons.size());
                scene.polygons.push_back(polygon);
                mesh.lookup.addGrid(scene, polygon, patch, 1, 1);
                if (backs[patch] == kNone) {
                    mesh.polygon[patch] = index;
                    continue;
                }
                mesh.lookup.setBack(index, backs[patch]);
                mesh.polygon[patch] = mesh.polygon[backs[patch]] = index;
            }
        }
        return scene;
    }

    void readLight(StoredSolution& result) {
        RadiositySolution& solution = result.solution;
        const auto wide = [](const std::vector<Rgb>& values) {
            return std::vector<RgbSum>(values.begin(), values.end());
        };
        solution.irradiance = wide(colours("irradiance", -kMost, kMost));
        solution.radiosity = wide(colours("radiosity", -kMost, kMost));
        solution.covered = numbers("covered", -kMost, kMost);
        if (has("standard_error")) result.standardError = colours("standard_error", 0.0F, kMost);
        if (!has("bounces")) return;
        const json& bounces = member("bounces");
        if (!bounces.is_array()) failAt("bounces", oneLine(bounces.dump(), 60), "an array");
        for (std::size_t k = 0; k < bounces.size(); ++k)
            solution.bounces.push_back(vectors(bounces[k], fmt::format("bounces/{}", k), patches_, -kMost, kMost));
    }

    RgbSum power(const char* name) const {
        const json& values = member("energy");
        const std::string place = fmt::format("energy/{}", name);
        if (!values.is_object() || !values.contains(name) || !values[name].is_array() || values[name].size() != 3)
            failAt(place, "nothing", "3 numbers");
        RgbSum result;
        for (int c = 0; c < 3; ++c) result[c] = number(values[name][static_cast<std::size_t>(c)], place);
        return result;
    }

    void readRun(RadiositySolution& solution) const {
        solution.iterations = whole("iterations");
        solution.residual = number(member("residual"), "residual");
        const json& history = member("history");
        if (!history.is_array()) failAt("history", oneLine(history.dump(), 60), "an array");
        for (std::size_t k = 0; k < history.size(); ++k) {
            const std::string place = fmt::format("history/{}", k);
            const json& step = history[k];
            if (!step.is_object() || !step.contains("iteration") || !step.contains("residual"))
                failAt(place, oneLine(step.dump(), 60), "an object with iteration and residual");
            solution.history.push_back({whole(step["iteration"], place), number(step["residual"], place), 0.0});
        }
        solution.energy = {power("emitted"), power("received"), power("absorbed"), power("back_faces"),
                           power("escaped")};
    }

    static constexpr float kMost = std::numeric_limits<float>::max();
    static constexpr float kFarthest = 1e15F; ///< metres; squares of areas are finite

    std::string file_;
    json extras_, lambert_;
    gltf::Model model_;
    std::size_t bytesLeft_ = 0, patches_ = 0;
    std::vector<std::uint32_t> fronts_; ///< of the second sides
};

} // namespace

StoredSolution readSolution(const std::filesystem::path& path) { return SolutionReader(path).read(); }

std::vector<RgbSum> readStart(const std::filesystem::path& path, const PatchMesh& mesh, const glm::dvec3& origin) {
    StoredSolution stored = readSolution(path);
    const PatchMesh& found = stored.meshed.mesh;
    if (found.size() != mesh.size())
        throw InputError(
            fmt::format("{}: found {} patches, the scene has {}; mesh options such as --patches must be those it was "
                        "made with",
                        path.string(), found.size(), mesh.size()));
    if (found.frontCount != mesh.frontCount || found.corners != mesh.corners || found.positions != mesh.positions ||
        stored.meshed.scene->origin != origin)
        throw InputError(
            fmt::format("{}: found patches that lie elsewhere than the scene's: it is of another scene or was made "
                        "with other mesh options",
                        path.string()));
    return std::move(stored.solution.irradiance);
}

} // namespace lambert
