#include "baking/encode.h"
#include "baking/exposure.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

namespace lambert {

namespace {

/// The material's name; a number where it has none, or where a line break would end the line.
std::string objName(const BakedMesh& mesh, std::uint32_t material) {
    std::string name = mesh.materials[material].name;
    if (name.empty()) return fmt::format("material{}", material);
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '\n' || c == '\r'; }, '_');
    return name;
}

void appendVertices(const BakedMesh& mesh, const BakeOutputOptions& options, std::string& text) {
    auto out = std::back_inserter(text);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::vec3 p = mesh.positions[v] + 0.0F; // no negative zeros
        const Rgb colour = displayColour(shownRadiance(mesh, v, options.quantity), options.exposure);
        fmt::format_to(out, "v {} {} {} {:.5f} {:.5f} {:.5f}\n", p.x, p.y, p.z, srgbEncode(colour.x),
                       srgbEncode(colour.y), srgbEncode(colour.z));
    }
    for (const glm::vec3& normal : mesh.normals) {
        const glm::vec3 n = normal + 0.0F;
        fmt::format_to(out, "vn {} {} {}\n", n.x, n.y, n.z);
    }
}

void appendFaces(const BakedMesh& mesh, std::string& text) {
    auto out = std::back_inserter(text);
    std::uint32_t current = kNone;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        if (mesh.faceMaterials[face] != current) {
            current = mesh.faceMaterials[face];
            fmt::format_to(out, "usemtl {}\n", objName(mesh, current));
        }
        text += 'f';
        for (std::size_t k = 0; k < (mesh.isQuad(face) ? 4U : 3U); ++k) {
            const std::uint64_t index = std::uint64_t{mesh.faces[face][k]} + 1; // OBJ counts from 1
            fmt::format_to(out, " {}//{}", index, index);
        }
        text += '\n';
    }
}

} // namespace

std::string encodeObj(const BakedMesh& mesh, const BakeOutputOptions& options, const std::string& materialFile) {
    std::string text = fmt::format("# Lambert {}\n"
                                   "# metres; v x y z r g b: r g b = sRGB of clamp({}/pi * 2^exposure_ev)\n"
                                   "# quantity {}\n"
                                   "# exposure_ev {}\n"
                                   "mtllib {}\n",
                                   options.version, options.quantity == Quantity::Radiosity ? "B" : "E",
                                   nameOf(options.quantity), options.exposure + 0.0F, materialFile);
    appendVertices(mesh, options, text);
    appendFaces(mesh, text);
    return text;
}

std::string encodeMtl(const BakedMesh& mesh) {
    std::string text = "# white: the light is in the vertex colours\n";
    const std::set<std::uint32_t> used(mesh.faceMaterials.begin(), mesh.faceMaterials.end());
    std::set<std::string> written;
    for (const std::uint32_t material : used) {
        const std::string name = objName(mesh, material);
        if (written.insert(name).second) text += fmt::format("newmtl {}\nKd 1 1 1\nKa 0 0 0\nillum 0\n", name);
    }
    return text;
}

} // namespace lambert
