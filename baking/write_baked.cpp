#include "baking/write_baked.h"

#include "baking/encode.h"
#include "core/error.h"
#include "core/named.h"
#include "core/text.h"
#include "core/whole_file.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cmath>
#include <span>

namespace lambert {

namespace {

void requireFinite(std::span<const glm::vec3> values, const char* what, const std::filesystem::path& path) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        const glm::vec3& v = values[i];
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
            throw SystemError(fmt::format("{}: not written: the {} of vertex {} is not finite ({}, {}, {})",
                                          path.string(), what, i, v.x, v.y, v.z));
    }
}

void writeObj(const BakedMesh& mesh, const std::filesystem::path& path, const BakeOutputOptions& options) {
    std::filesystem::path materials = path;
    materials.replace_extension(".mtl");
    const std::string name = materials.filename().string();
    writeWholeFiles(
        std::array{FileStream{materials, [&](std::ostream& stream) { encodeMtl(mesh, stream); }},
                   FileStream{path, [&](std::ostream& stream) { encodeObj(mesh, options, name, stream); }}});
}

void write(const BakedMesh& mesh, const std::filesystem::path& path, BakedFormat format,
           const BakeOutputOptions& options) {
    if (format == BakedFormat::Obj) return writeObj(mesh, path, options);
    writeWholeFile(path, [&](std::ostream& stream) {
        if (format == BakedFormat::Ply)
            encodePly(mesh, options, stream);
        else
            encodeGltf(mesh, options, format == BakedFormat::Glb, path.string(), stream);
    });
}

} // namespace

std::optional<BakedFormat> formatOf(const std::filesystem::path& path) {
    static constexpr std::array kFormats{Named{BakedFormat::Glb, ".glb"}, Named{BakedFormat::Gltf, ".gltf"},
                                         Named{BakedFormat::Ply, ".ply"}, Named{BakedFormat::Obj, ".obj"}};
    return valueNamed(kFormats, lowerCase(path.extension().string()));
}

const char* nameOf(Quantity quantity) { return quantity == Quantity::Radiosity ? "radiosity" : "irradiance"; }

void writeBaked(const BakedMesh& mesh, const std::filesystem::path& path, BakedFormat format,
                const BakeOutputOptions& options) {
    requireFinite(mesh.positions, "position", path);
    requireFinite(mesh.normals, "normal", path);
    requireFinite(mesh.radiosity, "radiosity", path);
    requireFinite(mesh.irradiance, "irradiance", path);
    const bool gltf = format == BakedFormat::Glb || format == BakedFormat::Gltf;
    if (gltf || mesh.opacity.empty())
        write(mesh, path, format, options);
    else
        write(withoutHoles(mesh), path, format, options);
}

} // namespace lambert
