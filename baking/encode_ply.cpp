#include "baking/encode.h"
#include "baking/exposure.h"
#include "core/byte_writer.h"
#include "picture/srgb.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace lambert {

namespace {

/// Single precision would lose the places.
bool isFarAway(const BakedMesh& mesh) { return mesh.origin != glm::dvec3(0.0); }

std::string header(const BakedMesh& mesh, const BakeOutputOptions& options) {
    std::string text;
    auto out = std::back_inserter(text);
    fmt::format_to(out,
                   "ply\n"
                   "format binary_little_endian 1.0\n"
                   "comment Lambert {}\n"
                   "comment metres; red green blue = sRGB of clamp({}/pi * 2^exposure_ev)\n"
                   "comment exposure_ev {}\n"
                   "comment radiosity_r g b: B per m2, linear, Rec. 709\n"
                   "element vertex {}\n",
                   options.version, options.quantity == Quantity::Radiosity ? "B" : "E", options.exposure + 0.0F,
                   mesh.positions.size());
    for (const char* name : {"x", "y", "z"})
        fmt::format_to(out, "property {} {}\n", isFarAway(mesh) ? "double" : "float", name);
    for (const char* name : {"nx", "ny", "nz"}) fmt::format_to(out, "property float {}\n", name);
    for (const char* name : {"red", "green", "blue"}) fmt::format_to(out, "property uchar {}\n", name);
    for (const char channel : {'r', 'g', 'b'}) fmt::format_to(out, "property float radiosity_{}\n", channel);
    if (options.quantity == Quantity::Irradiance)
        for (const char channel : {'r', 'g', 'b'}) fmt::format_to(out, "property float irradiance_{}\n", channel);
    fmt::format_to(out, "element face {}\nproperty list uchar uint vertex_indices\nend_header\n", mesh.faces.size());
    return text;
}

std::uint8_t srgbByte(float linear) { return static_cast<std::uint8_t>(std::lround(255.0F * srgbEncode(linear))); }

} // namespace

void encodePly(const BakedMesh& mesh, const BakeOutputOptions& options, std::ostream& stream) {
    const bool withIrradiance = options.quantity == Quantity::Irradiance;
    stream << header(mesh, options);
    ByteWriter out(stream);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (isFarAway(mesh))
            out.put(mesh.origin + glm::dvec3(mesh.positions[v]));
        else
            out.put(mesh.positions[v]);
        out.put(mesh.normals[v]);
        const Rgb colour = displayColour(shownRadiance(mesh, v, options.quantity), options.exposure);
        for (int c = 0; c < 3; ++c) out.put(srgbByte(colour[c]));
        out.put(mesh.radiosity[v]);
        if (withIrradiance) out.put(mesh.irradiance[v]);
    }
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        const std::uint8_t count = mesh.isQuad(face) ? 4 : 3;
        out.put(count);
        for (std::size_t k = 0; k < count; ++k) out.put(mesh.faces[face][k]);
    }
}

} // namespace lambert
