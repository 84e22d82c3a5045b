#include "baking/byte_writer.h"
#include "baking/encode.h"
#include "baking/exposure.h"
#include "core/error.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include <limits>
#include <sstream>

namespace lambert {

namespace {

using Json = tinygltf::Value;
using Triangle = std::array<std::uint32_t, 3>;

constexpr std::uint64_t kLargestFile = 0xFFFFFFFF; ///< a GLB holds its length in 32 bits

/// glTF is UTF-8. A name that is not (MTL files have no encoding) is taken for Latin-1.
std::string utf8Name(const std::string& name) {
    try {
        (void)nlohmann::json(name).dump();
        return name;
    } catch (const nlohmann::json::exception&) {
    }
    std::string result;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x80) {
            result += c;
        } else {
            result += static_cast<char>(0xC0 | byte >> 6);
            result += static_cast<char>(0x80 | (byte & 0x3F));
        }
    }
    return result;
}

void requireFits(std::uint64_t bytes) {
    if (bytes > kLargestFile)
        throw SystemError("glTF files end at 4294967295 bytes and this one needs more; write .ply instead");
}

/// Splits a quad along the diagonal over which the shown light, or BakedMesh::splitBy, changes less; the shorter one where
/// both are equal.
bool splitsAlongFirstDiagonal(const BakedMesh& mesh, const std::array<std::uint32_t, 4>& quad, Quantity quantity) {
    const auto change = [&](std::size_t a, std::size_t b) {
        const Rgb d = mesh.splitBy.empty()
                          ? shownRadiance(mesh, quad[a], quantity) - shownRadiance(mesh, quad[b], quantity)
                          : mesh.splitBy[quad[a]] - mesh.splitBy[quad[b]];
        return glm::dot(d, d);
    };
    const float first = change(0, 2);
    const float second = change(1, 3);
    if (first != second) return first < second;
    return glm::distance(mesh.positions[quad[0]], mesh.positions[quad[2]]) <=
           glm::distance(mesh.positions[quad[1]], mesh.positions[quad[3]]);
}

/// The triangles of each material.
std::vector<std::vector<Triangle>> trianglesByMaterial(const BakedMesh& mesh, Quantity quantity) {
    std::vector<std::vector<Triangle>> result(mesh.materials.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        const auto& [a, b, c, d] = mesh.faces[face];
        std::vector<Triangle>& triangles = result[mesh.faceMaterials[face]];
        if (!mesh.isQuad(face)) {
            triangles.push_back({a, b, c});
        } else if (splitsAlongFirstDiagonal(mesh, mesh.faces[face], quantity)) {
            triangles.push_back({a, b, c});
            triangles.push_back({a, c, d});
        } else {
            triangles.push_back({a, b, d});
            triangles.push_back({b, c, d});
        }
    }
    return result;
}

/// Builds the asset; every accessor has its own buffer view, because tinygltf writes an accessor's offset as
/// an int.
class GltfEncoder {
public:
    GltfEncoder(const BakedMesh& mesh, const BakeOutputOptions& options)
        : mesh_(mesh), options_(options), localVertex_(mesh.positions.size(), kNone) {}

    tinygltf::Model build() {
        describeAsset();
        tinygltf::Mesh mesh;
        const std::vector<std::vector<Triangle>> triangles = trianglesByMaterial(mesh_, options_.quantity);
        for (std::uint32_t material = 0; material < triangles.size(); ++material)
            if (!triangles[material].empty()) mesh.primitives.push_back(primitive(triangles[material], material));
        if (!mesh.primitives.empty()) addScene(std::move(mesh));
        return std::move(model_);
    }

private:
    void describeAsset() {
        const bool irradiance = options_.quantity == Quantity::Irradiance;
        Json::Object extras;
        extras["exposure_ev"] = Json(static_cast<double>(options_.exposure + 0.0F));
        extras["quantity"] = Json(std::string(nameOf(options_.quantity)));
        extras["_RADIOSITY"] = Json(std::string("B = π L, linear Rec. 709, per m²"));
        if (irradiance) extras["_IRRADIANCE"] = Json(std::string("E, linear Rec. 709, per m²"));
        extras["COLOR_0"] = Json(fmt::format("clamp({}/π · 2^exposure_ev)", irradiance ? "E" : "B"));
        model_.asset.version = "2.0";
        model_.asset.generator = options_.version.empty() ? "Lambert" : "Lambert " + options_.version;
        model_.asset.extras = Json(std::move(extras));
        if (!mesh_.faces.empty()) model_.extensionsUsed.push_back("KHR_materials_unlit");
    }

    void addScene(tinygltf::Mesh mesh) {
        model_.meshes.push_back(std::move(mesh));
        tinygltf::Node node;
        node.mesh = 0;
        model_.nodes.push_back(std::move(node));
        tinygltf::Scene scene;
        scene.nodes.push_back(0);
        model_.scenes.push_back(std::move(scene));
        model_.defaultScene = 0;
        tinygltf::Buffer buffer;
        buffer.data.assign(bytes_.begin(), bytes_.end());
        model_.buffers.push_back(std::move(buffer));
    }

    int addMaterial(std::uint32_t index) {
        tinygltf::Material material;
        material.name = utf8Name(mesh_.materials[index].name);
        material.extensions["KHR_materials_unlit"] = Json(Json::Object());
        material.pbrMetallicRoughness.metallicFactor = 0.0; // for viewers that do not know the extension
        model_.materials.push_back(std::move(material));
        return static_cast<int>(model_.materials.size()) - 1;
    }

    /// The accessor of `count` elements that were appended to the buffer since `begin`.
    int addAccessor(std::size_t begin, std::size_t count, bool indices) {
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = begin;
        view.byteLength = bytes_.size() - begin;
        view.target = indices ? TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER : TINYGLTF_TARGET_ARRAY_BUFFER;
        model_.bufferViews.push_back(std::move(view));
        tinygltf::Accessor accessor;
        accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
        accessor.componentType = indices ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT : TINYGLTF_COMPONENT_TYPE_FLOAT;
        accessor.type = indices ? TINYGLTF_TYPE_SCALAR : TINYGLTF_TYPE_VEC3;
        accessor.count = count;
        model_.accessors.push_back(std::move(accessor));
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    /// `value(v)` is the attribute of the mesh's vertex v.
    template <typename Value>
    int addAttribute(const std::vector<std::uint32_t>& vertices, const Value& value) {
        const std::size_t begin = bytes_.size();
        ByteWriter out(bytes_);
        for (const std::uint32_t v : vertices) out.put(value(v));
        return addAccessor(begin, vertices.size(), false);
    }

    void setBounds(tinygltf::Accessor& accessor, const std::vector<std::uint32_t>& vertices) const {
        glm::vec3 lower(std::numeric_limits<float>::max());
        glm::vec3 upper(std::numeric_limits<float>::lowest());
        for (const std::uint32_t v : vertices) {
            lower = glm::min(lower, mesh_.positions[v]);
            upper = glm::max(upper, mesh_.positions[v]);
        }
        lower += 0.0F; // no negative zeros
        upper += 0.0F;
        accessor.minValues = {lower.x, lower.y, lower.z};
        accessor.maxValues = {upper.x, upper.y, upper.z};
    }

    /// The mesh's vertices that the triangles use, in order of first use; `localVertex_` then knows their
    /// places.
    std::vector<std::uint32_t> compact(const std::vector<Triangle>& triangles) {
        std::vector<std::uint32_t> vertices;
        for (const Triangle& triangle : triangles) {
            for (const std::uint32_t v : triangle) {
                if (localVertex_[v] != kNone) continue;
                localVertex_[v] = static_cast<std::uint32_t>(vertices.size());
                vertices.push_back(v);
            }
        }
        return vertices;
    }

    tinygltf::Primitive primitive(const std::vector<Triangle>& triangles, std::uint32_t material) {
        const std::vector<std::uint32_t> vertices = compact(triangles);
        const std::size_t attributes = options_.quantity == Quantity::Irradiance ? 5 : 4;
        const std::uint64_t bytes = bytes_.size() + vertices.size() * attributes * 12 + triangles.size() * 12;
        requireFits(bytes);

        tinygltf::Primitive result;
        result.mode = TINYGLTF_MODE_TRIANGLES;
        result.material = addMaterial(material);
        result.attributes["POSITION"] = addAttribute(vertices, [&](auto v) { return mesh_.positions[v]; });
        setBounds(model_.accessors.back(), vertices);
        result.attributes["NORMAL"] = addAttribute(vertices, [&](auto v) { return mesh_.normals[v]; });
        result.attributes["COLOR_0"] = addAttribute(vertices, [&](auto v) {
            return displayColour(shownRadiance(mesh_, v, options_.quantity), options_.exposure);
        });
        result.attributes["_RADIOSITY"] = addAttribute(vertices, [&](auto v) { return mesh_.radiosity[v]; });
        if (options_.quantity == Quantity::Irradiance)
            result.attributes["_IRRADIANCE"] = addAttribute(vertices, [&](auto v) { return mesh_.irradiance[v]; });

        const std::size_t begin = bytes_.size();
        ByteWriter out(bytes_);
        for (const Triangle& triangle : triangles)
            for (const std::uint32_t v : triangle) out.put(localVertex_[v]);
        result.indices = addAccessor(begin, triangles.size() * 3, true);
        for (const std::uint32_t v : vertices) localVertex_[v] = kNone;
        return result;
    }

    const BakedMesh& mesh_;
    const BakeOutputOptions& options_;
    tinygltf::Model model_;
    std::string bytes_;                      ///< of the one buffer
    std::vector<std::uint32_t> localVertex_; ///< #vertices, the place in the current primitive or kNone
};

} // namespace

std::string encodeGltf(const BakedMesh& mesh, const BakeOutputOptions& options, bool binary) {
    const tinygltf::Model model = GltfEncoder(mesh, options).build();
    std::ostringstream stream;
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model, stream, !binary, binary))
        throw SystemError("tinygltf cannot serialise the baked mesh");
    std::string bytes = std::move(stream).str();
    requireFits(bytes.size());
    return bytes;
}

} // namespace lambert
