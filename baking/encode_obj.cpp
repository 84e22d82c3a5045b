#include "baking/encode.h"
#include "baking/exposure.h"
#include "picture/srgb.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

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

/// Of a vertex, with as many digits as it takes to read the same number again.
std::string placeText(const BakedMesh& mesh, std::size_t vertex) {
    const glm::vec3 p = mesh.positions[vertex] + 0.0F; // no negative zeros
    if (mesh.origin == glm::dvec3(0.0)) return fmt::format("{} {} {}", p.x, p.y, p.z);
    const glm::dvec3 place = mesh.origin + glm::dvec3(p);
    return fmt::format("{} {} {}", place.x, place.y, place.z);
}

void putVertices(const BakedMesh& mesh, const BakeOutputOptions& options, std::ostream& stream) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Rgb colour = displayColour(shownRadiance(mesh, v, options.quantity), options.exposure);
        fmt::print(stream, "v {} {:.5f} {:.5f} {:.5f}\n", placeText(mesh, v), srgbEncode(colour.x),
                   srgbEncode(colour.y), srgbEncode(colour.z));
    }
    for (const glm::vec3& normal : mesh.normals) {
        const glm::vec3 n = normal + 0.0F;
        fmt::print(stream, "vn {} {} {}\n", n.x, n.y, n.z);
    }
}

void putFaces(const BakedMesh& mesh, std::ostream& stream) {
    std::string line;
    std::uint32_t current = kNone;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        if (mesh.faceMaterials[face] != current) {
            current = mesh.faceMaterials[face];
            fmt::print(stream, "usemtl {}\n", objName(mesh, current));
        }
        line.assign(1, 'f');
        for (std::size_t k = 0; k < (mesh.isQuad(face) ? 4U : 3U); ++k) {
            const std::uint64_t index = std::uint64_t{mesh.faces[face][k]} + 1; // OBJ counts from 1
            fmt::format_to(std::back_inserter(line), " {}//{}", index, index);
        }
        stream << line << '\n';
    }
}

} // namespace

void encodeObj(const BakedMesh& mesh, const BakeOutputOptions& options, const std::string& materialFile,
               std::ostream& stream) {
    fmt::print(stream,
               "# Lambert {}\n"
               "# metres; v x y z r g b: r g b = sRGB of clamp({}/pi * 2^exposure_ev)\n"
               "# quantity {}\n"
               "# exposure_ev {}\n"
               "mtllib {}\n",
               options.version, options.quantity == Quantity::Radiosity ? "B" : "E", nameOf(options.quantity),
               options.exposure + 0.0F, materialFile);
    putVertices(mesh, options, stream);
    putFaces(mesh, stream);
}

void encodeMtl(const BakedMesh& mesh, std::ostream& stream) {
    stream << "# white: the light is in the vertex colours\n";
    const std::set<std::uint32_t> used(mesh.faceMaterials.begin(), mesh.faceMaterials.end());
    std::set<std::string> written;
    for (const std::uint32_t material : used) {
        const std::string name = objName(mesh, material);
        if (written.insert(name).second) fmt::print(stream, "newmtl {}\nKd 1 1 1\nKa 0 0 0\nillum 0\n", name);
    }
}

} // namespace lambert
