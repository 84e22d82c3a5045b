#include "baking/byte_writer.h"
#include "baking/encode.h"
#include "baking/solution_file.h"
#include "core/error.h"
#include "core/whole_file.h"
#include "scene/input_file.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace lambert {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedInt = 5125;  ///< component types of glTF
constexpr int kVertices = 34962, kIndices = 34963; ///< targets of buffer views

Json jsonOf(const RgbSum& value) { return Json::array({value.x, value.y, value.z}); }

class SolutionEncoder {
public:
    SolutionEncoder(const SolutionRecord& record, std::string file) : record_(record), file_(std::move(file)) {}

    void encode() {
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
        addPatches(lambert);
        addLight(lambert);
        addRun(lambert);
        document_["extras"]["lambert"] = std::move(lambert);
        document_["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
    }

    /// The container around both parts, each filled up to whole words.
    void write(std::ostream& stream) {
        std::string text = document_.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const std::uint64_t total = 12 + 8 + text.size() + 8 + bytes_.size();
        if (total > std::numeric_limits<std::uint32_t>::max())
            throw SystemError(fmt::format(
                "{}: not written: a solution file ends at 4294967295 bytes, and this one needs {}", file_, total));
        const auto put = [&](std::initializer_list<std::uint64_t> words) {
            std::string head;
            ByteWriter out(head);
            for (const std::uint64_t word : words) out.put(static_cast<std::uint32_t>(word));
            stream << head;
        };
        put({0x46546C67, 2, total, text.size(), 0x4E4F534A}); // "glTF", version, "JSON"
        stream << text;
        put({bytes_.size(), 0x004E4942}); // "BIN"
        stream << bytes_;
    }

private:
    /// The accessor of what was appended to the buffer since `begin`.
    std::size_t addAccessor(std::size_t begin, std::size_t count, int component, const char* type, int target = 0) {
        Json view = {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes_.size() - begin}};
        if (target != 0) view["target"] = target;
        document_["bufferViews"].push_back(std::move(view));
        Json accessor = {{"bufferView", document_["bufferViews"].size() - 1},
                         {"componentType", component},
                         {"count", count},
                         {"type", type}};
        document_["accessors"].push_back(std::move(accessor));
        return document_["accessors"].size() - 1;
    }

    void requireFinite(float value, const char* what, std::size_t k) const {
        if (!std::isfinite(value))
            throw SystemError(fmt::format("{}: not written: {} {} is not finite ({})", file_, what, k, value));
    }

    template <typename Colours>
    std::size_t addColours(const Colours& values, const char* what, int target = 0) {
        const std::size_t begin = bytes_.size();
        ByteWriter out(bytes_);
        for (std::size_t k = 0; k < values.size(); ++k) {
            const Rgb value(values[k]);
            for (int c = 0; c < 3; ++c) requireFinite(value[c], what, k);
            out.put(value);
        }
        return addAccessor(begin, values.size(), kFloat, "VEC3", target);
    }

    std::size_t addNumbers(const std::vector<float>& values, const char* what) {
        const std::size_t begin = bytes_.size();
        ByteWriter out(bytes_);
        for (std::size_t k = 0; k < values.size(); ++k) {
            requireFinite(values[k], what, k);
            out.put(values[k]);
        }
        return addAccessor(begin, values.size(), kFloat, "SCALAR");
    }

    std::size_t addIndices(const std::vector<std::uint32_t>& values, int target = 0) {
        const std::size_t begin = bytes_.size();
        ByteWriter out(bytes_);
        for (const std::uint32_t value : values) out.put(value);
        return addAccessor(begin, values.size(), kUnsignedInt, "SCALAR", target);
    }

    std::size_t addPositions() {
        const std::vector<glm::vec3>& positions = record_.mesh.positions;
        const std::size_t index = addColours(positions, "position", kVertices);
        glm::vec3 lower(std::numeric_limits<float>::max()), upper(std::numeric_limits<float>::lowest());
        for (const glm::vec3& p : positions) {
            lower = glm::min(lower, p);
            upper = glm::max(upper, p);
        }
        document_["accessors"][index]["min"] = jsonOf(RgbSum(lower + 0.0F)); // no negative zeros
        document_["accessors"][index]["max"] = jsonOf(RgbSum(upper + 0.0F));
        return index;
    }

    bool isHole(std::size_t patch) const {
        return !record_.mesh.opacity.empty() && record_.mesh.opacity[patch] == 0.0F;
    }

    /// What any viewer shows: the fronts, one primitive per material, grey.
    void addDrawing(std::size_t positions) {
        const PatchMesh& mesh = record_.mesh;
        const std::vector<Material>& materials = record_.scene.materials;
        std::vector<std::vector<std::uint32_t>> corners(materials.size());
        std::vector<bool> twoSided(materials.size(), false);
        for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
            if (mesh.isBack(patch)) twoSided[mesh.material[patch]] = true;
            if (mesh.isBack(patch) || isHole(patch)) continue;
            std::vector<std::uint32_t>& of = corners[mesh.material[patch]];
            const auto& [a, b, c, d] = mesh.corners[patch];
            of.insert(of.end(), {a, b, c});
            if (mesh.isQuad(patch)) of.insert(of.end(), {a, c, d});
        }
        Json primitives = Json::array();
        for (std::size_t m = 0; m < materials.size(); ++m) {
            Json material = {{"name", asUtf8(materials[m].name)}, {"pbrMetallicRoughness", {{"metallicFactor", 0.0}}}};
            if (twoSided[m]) material["doubleSided"] = true;
            document_["materials"].push_back(std::move(material));
            if (corners[m].empty()) continue;
            primitives.push_back({{"attributes", {{"POSITION", positions}}},
                                  {"indices", addIndices(corners[m], kIndices)},
                                  {"material", m}});
        }
        if (primitives.empty()) return;
        document_["meshes"] = Json::array({{{"primitives", std::move(primitives)}}});
        document_["nodes"] = Json::array({{{"mesh", 0}}});
        document_["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
        document_["scene"] = 0;
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
        std::vector<std::uint32_t> corners;
        corners.reserve(4 * mesh.size());
        for (const auto& patch : mesh.corners) corners.insert(corners.end(), patch.begin(), patch.end());
        lambert["corners"] = addIndices(corners);
        if (mesh.size() > mesh.frontCount) lambert["fronts"] = addIndices(frontsOfBacks());
        lambert["material"] = addIndices(mesh.material);
        lambert["area"] = addNumbers(mesh.area, "area");
        if (!mesh.opacity.empty()) lambert["opacity"] = addNumbers(mesh.opacity, "opacity");
        lambert["reflectance"] = addColours(mesh.reflectance, "reflectance");
        lambert["emitted_radiosity"] = addColours(mesh.emittedRadiosity, "emitted radiosity");
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
    Json document_ = {
        {"asset",
         {{"version", "2.0"}, {"generator", record_.version.empty() ? "Lambert" : "Lambert " + record_.version}}}};
    std::string bytes_; ///< of the one buffer
};

} // namespace

void requireSolutionName(const std::filesystem::path& path, const char* option) {
    if (formatOf(path) != BakedFormat::Glb)
        throw UsageError(fmt::format("{}: found \"{}\", allowed are names ending in .glb", option, path.string()));
}

void writeSolution(const SolutionRecord& record, const std::filesystem::path& path) {
    SolutionEncoder encoder(record, path.string());
    encoder.encode();
    writeWholeFile(path, [&](std::ostream& stream) { encoder.write(stream); });
}

} // namespace lambert
