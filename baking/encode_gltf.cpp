#include "baking/encode.h"

#include "baking/exposure.h"
#include "core/box.h"
#include "core/text.h"
#include "scene/gltf/writer.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace lambert {

namespace {

using Json = GltfWriter::Json;
using Triangle = std::array<std::uint32_t, 3>;

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

/// The triangles of each material, without holes, as indices of the mesh's vertices.
std::vector<std::vector<Triangle>> trianglesByMaterial(const BakedMesh& mesh, Quantity quantity) {
    std::vector<std::vector<Triangle>> result(mesh.materials.size());
    std::vector<std::size_t> counts(mesh.materials.size(), 0);
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        if (!isHole(mesh, face)) counts[mesh.faceMaterials[face]] += mesh.isQuad(face) ? 2 : 1;
    for (std::size_t material = 0; material < counts.size(); ++material) result[material].reserve(counts[material]);
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        if (isHole(mesh, face)) continue;
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

/// What is drawn with one material.
struct Part {
    std::vector<std::uint32_t> vertices; ///< into the mesh's, in order of first use
    std::vector<Triangle> triangles;     ///< into `vertices`
};

/// Numbers the vertices anew; `places` is #vertices of the mesh, all kNone before and after.
Part makePart(std::vector<Triangle> triangles, std::vector<std::uint32_t>& places) {
    Part part;
    for (Triangle& triangle : triangles) {
        for (std::uint32_t& v : triangle) {
            if (places[v] == kNone) {
                places[v] = static_cast<std::uint32_t>(part.vertices.size());
                part.vertices.push_back(v);
            }
            v = places[v];
        }
    }
    for (const std::uint32_t v : part.vertices) places[v] = kNone;
    part.triangles = std::move(triangles);
    return part;
}

class GltfEncoder {
public:
    GltfEncoder(const BakedMesh& mesh, const BakeOutputOptions& options)
        : mesh_(mesh), options_(options), writer_(options.version) {}

    void write(std::ostream& stream, bool binary, const std::string& file) {
        describeAsset();
        std::vector<std::vector<Triangle>> triangles = trianglesByMaterial(mesh_, options_.quantity);
        std::vector<std::uint32_t> places(mesh_.positions.size(), kNone);
        parts_.resize(triangles.size());
        Json primitives = Json::array();
        for (std::size_t material = 0; material < triangles.size(); ++material) {
            if (triangles[material].empty()) continue;
            parts_[material] = makePart(std::move(triangles[material]), places);
            primitives.push_back(primitive(parts_[material], material));
        }
        places = {};
        writer_.addScene(std::move(primitives), mesh_.origin);
        writer_.write(stream, binary, file);
    }

private:
    void describeAsset() {
        const bool irradiance = options_.quantity == Quantity::Irradiance;
        Json extras = {{"exposure_ev", options_.exposure + 0.0F},
                       {"quantity", nameOf(options_.quantity)},
                       {"COLOR_0", fmt::format("clamp({}/π · 2^exposure_ev)", irradiance ? "E" : "B")},
                       {"_RADIOSITY", "B = π L, linear Rec. 709, per m²"}};
        if (irradiance) extras["_IRRADIANCE"] = "E, linear Rec. 709, per m²";
        Json& document = writer_.document();
        document["asset"]["extras"] = std::move(extras);
        if (!mesh_.faces.empty()) document["extensionsUsed"] = Json::array({"KHR_materials_unlit"});
    }

    std::size_t addMaterial(std::size_t index) {
        Json& materials = writer_.document()["materials"];
        materials.push_back({{"name", asUtf8(mesh_.materials[index].name)},
                             {"extensions", {{"KHR_materials_unlit", Json::object()}}},
                             // For viewers that do not know the extension.
                             {"pbrMetallicRoughness", {{"metallicFactor", 0.0}}}});
        return materials.size() - 1;
    }

    /// `value(v)` is the attribute of the mesh's vertex v; `part` stays where it is until all is written.
    template <typename Value>
    std::size_t addAttribute(const Part& part, Value value) {
        return writer_.addVectors(
            part.vertices.size(),
            [&part, value](ByteWriter& out) {
                for (const std::uint32_t v : part.vertices) out.put(value(v));
            },
            GltfWriter::Target::Vertices);
    }

    void setBounds(std::size_t accessor, const Part& part) {
        Box<glm::vec3> box;
        for (const std::uint32_t v : part.vertices) box.add(mesh_.positions[v]);
        writer_.setBounds(accessor, box.lower, box.upper);
    }

    Json primitive(const Part& part, std::size_t material) {
        Json attributes;
        const std::size_t positions = addAttribute(part, [this](auto v) { return mesh_.positions[v]; });
        setBounds(positions, part);
        attributes["POSITION"] = positions;
        attributes["NORMAL"] = addAttribute(part, [this](auto v) { return mesh_.normals[v]; });
        attributes["COLOR_0"] = addAttribute(part, [this](auto v) {
            return displayColour(shownRadiance(mesh_, v, options_.quantity), options_.exposure);
        });
        attributes["_RADIOSITY"] = addAttribute(part, [this](auto v) { return mesh_.radiosity[v]; });
        if (options_.quantity == Quantity::Irradiance)
            attributes["_IRRADIANCE"] = addAttribute(part, [this](auto v) { return mesh_.irradiance[v]; });
        const std::size_t indices = writer_.addIndices(
            part.triangles.size() * 3,
            [&part](ByteWriter& out) {
                for (const Triangle& triangle : part.triangles)
                    for (const std::uint32_t v : triangle) out.put(v);
            },
            GltfWriter::Target::Indices);
        return {{"attributes", std::move(attributes)}, {"indices", indices}, {"material", addMaterial(material)}};
    }

    const BakedMesh& mesh_;
    const BakeOutputOptions& options_;
    GltfWriter writer_;
    std::vector<Part> parts_; ///< by material
};

} // namespace

void encodeGltf(const BakedMesh& mesh, const BakeOutputOptions& options, bool binary, const std::string& file,
                std::ostream& stream) {
    GltfEncoder(mesh, options).write(stream, binary, file);
}

} // namespace lambert
