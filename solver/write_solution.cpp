#include "core/error.h"

#include "core/box.h"
#include "core/text.h"
#include "core/whole_file.h"
#include "scene/gltf/writer.h"
#include "solver/solution_file.h"

#include <fmt/format.h>

#include <cmath>

namespace lambert {

namespace {

using Json = GltfWriter::Json;

Json jsonOf(const RgbSum& value) { return Json::array({value.x, value.y, value.z}); }

class SolutionEncoder {
public:
    SolutionEncoder(const SolutionRecord& record, std::string file)
        : record_(record), file_(std::move(file)), writer_(record.version) {}

    void write(std::ostream& stream) {
        const PatchMesh& mesh = record_.mesh;
        const std::size_t positions = addPositions();
        addDrawing(positions);
        Json lambert = {{"format", 1},
                        {"scene", asUtf8(record_.origin.scene)},
                        {"method", record_.origin.method},
                        {"solver", record_.origin.solver},
                        {"patches", mesh.size()},
                        {"front_patches", mesh.frontCount},
                        {"positions", positions}};
        if (const glm::dvec3& origin = record_.scene.origin; origin != glm::dvec3(0.0))
            lambert["origin"] = jsonOf(origin);
        addPatches(lambert);
        addLight(lambert);
        addRun(lambert);
        writer_.document()["extras"]["lambert"] = std::move(lambert);
        writer_.write(stream, true, file_);
    }

private:
    float finite(float value, const char* what, std::size_t k) const {
        if (!std::isfinite(value))
            throw SystemError(fmt::format("{}: not written: {} {} is not finite ({})", file_, what, k, value));
        return value;
    }

    /// `values` stay where they are until all is written, here and below.
    template <typename Colours>
    std::size_t addColours(const Colours& values, const char* what,
                           GltfWriter::Target target = GltfWriter::Target::None) {
        return writer_.addVectors(
            values.size(),
            [this, &values, what](ByteWriter& out) {
                for (std::size_t k = 0; k < values.size(); ++k)
                    for (int c = 0; c < 3; ++c) out.put(finite(static_cast<float>(values[k][c]), what, k));
            },
            target);
    }

    std::size_t addNumbers(const std::vector<float>& values, const char* what) {
        return writer_.addNumbers(values.size(), [this, &values, what](ByteWriter& out) {
            for (std::size_t k = 0; k < values.size(); ++k) out.put(finite(values[k], what, k));
        });
    }

    std::size_t addIndices(const std::vector<std::uint32_t>& values,
                           GltfWriter::Target target = GltfWriter::Target::None) {
        return writer_.addIndices(
            values.size(),
            [&values](ByteWriter& out) {
                for (const std::uint32_t value : values) out.put(value);
            },
            target);
    }

    std::size_t addPositions() {
        const std::vector<glm::vec3>& positions = record_.mesh.positions;
        const std::size_t index = addColours(positions, "position", GltfWriter::Target::Vertices);
        Box<glm::vec3> box;
        for (const glm::vec3& p : positions) box.add(p);
        writer_.setBounds(index, box.lower, box.upper);
        return index;
    }

    bool isHole(std::size_t patch) const {
        return !record_.mesh.opacity.empty() && record_.mesh.opacity[patch] == 0.0F;
    }

    /// What any viewer shows: the fronts, one primitive per material, grey.
    void addDrawing(std::size_t positions) {
        const PatchMesh& mesh = record_.mesh;
        const std::vector<Material>& materials = record_.scene.materials;
        drawn_.resize(materials.size());
        std::vector<bool> twoSided(materials.size(), false);
        for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
            if (mesh.isBack(patch)) twoSided[mesh.material[patch]] = true;
            if (mesh.isBack(patch) || isHole(patch)) continue;
            std::vector<std::uint32_t>& of = drawn_[mesh.material[patch]];
            const auto& [a, b, c, d] = mesh.corners[patch];
            of.insert(of.end(), {a, b, c});
            if (mesh.isQuad(patch)) of.insert(of.end(), {a, c, d});
        }
        Json& document = writer_.document();
        Json primitives = Json::array();
        for (std::size_t m = 0; m < materials.size(); ++m) {
            Json material = {{"name", asUtf8(materials[m].name)}, {"pbrMetallicRoughness", {{"metallicFactor", 0.0}}}};
            if (twoSided[m]) material["doubleSided"] = true;
            document["materials"].push_back(std::move(material));
            if (drawn_[m].empty()) continue;
            primitives.push_back({{"attributes", {{"POSITION", positions}}},
                                  {"indices", addIndices(drawn_[m], GltfWriter::Target::Indices)},
                                  {"material", m}});
        }
        writer_.addScene(std::move(primitives), record_.scene.origin);
    }

    /// Of each second side, the front patch that it is the back of.
    std::vector<std::uint32_t> frontsOfBacks() const {
        const PatchMesh& mesh = record_.mesh;
        std::vector<std::uint32_t> fronts(mesh.size() - mesh.frontCount, kNone);
        for (std::uint32_t patch = 0; patch < mesh.frontCount && !fronts.empty(); ++patch)
            if (mesh.polygon[patch] != kNone)
                if (const std::uint32_t back = mesh.lookup.backPatch(mesh.polygon[patch], patch); back != kNone)
                    fronts[back - mesh.frontCount] = patch;
        return fronts;
    }

    void addPatches(Json& lambert) {
        const PatchMesh& mesh = record_.mesh;
        lambert["corners"] = writer_.addIndices(4 * mesh.size(), [&mesh](ByteWriter& out) {
            for (const auto& patch : mesh.corners)
                for (const std::uint32_t corner : patch) out.put(corner);
        });
        fronts_ = frontsOfBacks();
        if (!fronts_.empty()) lambert["fronts"] = addIndices(fronts_);
        lambert["material"] = addIndices(mesh.material);
        lambert["area"] = addNumbers(mesh.area, "area");
        if (!mesh.opacity.empty()) lambert["opacity"] = addNumbers(mesh.opacity, "opacity");
        lambert["reflectance"] = addColours(record_.optics.reflectance, "reflectance");
        lambert["emitted_radiosity"] = addColours(record_.optics.emittedRadiosity, "emitted radiosity");
    }

    void addLight(Json& lambert) {
        const RadiositySolution& solution = record_.solution;
        lambert["irradiance"] = addColours(solution.irradiance, "irradiance");
        lambert["radiosity"] = addColours(solution.radiosity, "radiosity");
        lambert["covered"] = addNumbers(solution.covered, "share that meets backs");
        if (!record_.standardError.empty())
            lambert["standard_error"] = addColours(record_.standardError, "standard error");
        for (const std::vector<Rgb>& bounce : solution.bounces)
            lambert["bounces"].push_back(addColours(bounce, "radiosity of a bounce"));
    }

    void addRun(Json& lambert) const {
        const RadiositySolution& solution = record_.solution;
        const EnergyBalance& energy = solution.energy;
        lambert["iterations"] = solution.iterations;
        lambert["residual"] = solution.residual;
        Json history = Json::array();
        for (const SolverStep& step : solution.history)
            history.push_back({{"iteration", step.iteration}, {"residual", step.residual}});
        lambert["history"] = std::move(history);
        lambert["energy"] = {{"emitted", jsonOf(energy.emitted)},
                             {"received", jsonOf(energy.received)},
                             {"absorbed", jsonOf(energy.absorbed)},
                             {"back_faces", jsonOf(energy.backFaces)},
                             {"escaped", jsonOf(energy.escaped)}};
    }

    const SolutionRecord& record_;
    std::string file_;
    GltfWriter writer_;
    std::vector<std::vector<std::uint32_t>> drawn_; ///< by material: corners of triangles
    std::vector<std::uint32_t> fronts_;             ///< see frontsOfBacks
};

} // namespace

void requireSolutionName(const std::filesystem::path& path, const char* option) {
    if (lowerCase(path.extension().string()) != ".glb")
        throw UsageError(fmt::format("{}: found \"{}\", allowed are names ending in .glb", option, path.string()));
}

void writeSolution(const SolutionRecord& record, const std::filesystem::path& path) {
    SolutionEncoder encoder(record, path.string());
    writeWholeFile(path, [&](std::ostream& stream) { encoder.write(stream); });
}

} // namespace lambert
