#include "core/error.h"
#include "scene/input_file.h"
#include "scene/obj_syntax.h"
#include "scene/scene_builder.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>

namespace lambert {

namespace {

/// The files that an `mtllib` statement names: one with spaces in its name, or several.
std::vector<std::filesystem::path> libraryPaths(const std::string& argument, const std::filesystem::path& folder) {
    const auto existing = [&](std::string name) -> std::filesystem::path {
        std::filesystem::path asWritten = folder / name;
        std::error_code error;
        if (std::filesystem::exists(asWritten, error)) return asWritten;
        std::replace(name.begin(), name.end(), '\\', '/'); // written on Windows
        return folder / name;
    };
    std::error_code error;
    if (std::filesystem::path whole = existing(argument); std::filesystem::exists(whole, error)) return {whole};
    std::vector<std::filesystem::path> paths;
    std::istringstream words(argument);
    for (std::string word; words >> word;) paths.push_back(existing(word));
    return paths;
}

/// Adds the materials of one MTL file, in its order; of two with the same name the first counts.
void addLibrary(SceneBuilder& builder, const std::filesystem::path& path,
                std::map<std::string, std::uint32_t>& materials) {
    std::string text;
    try {
        text = readInputFile(path);
    } catch (const InputError& error) {
        builder.warn(fmt::format("mtllib {}", error.what()));
        return;
    }
    MtlText checked = checkMtl(path.string(), text);
    for (const std::string& warning : checked.warnings) builder.warn(warning);

    std::istringstream stream(std::move(checked.statements));
    std::map<std::string, int> numbers;
    std::vector<tinyobj::material_t> found;
    std::string warnings, errors;
    tinyobj::LoadMtl(&numbers, &found, &stream, &warnings, &errors);
    for (const tinyobj::material_t& source : found) {
        if (source.name.empty()) continue; // tinyobjloader ends every list with one of these, if not a real one
        if (materials.contains(source.name)) {
            builder.warn(fmt::format("material {} is defined again in {}: the first counts", inQuotes(source.name),
                                     path.string()));
            continue;
        }
        Material material;
        material.name = source.name;
        material.reflectance = Rgb(source.diffuse[0], source.diffuse[1], source.diffuse[2]);
        material.emittedRadiance = Rgb(source.emission[0], source.emission[1], source.emission[2]);
        material.diffusePartOnly = checked.diffusePartOnly.contains(source.name);
        materials.emplace(source.name, builder.addMaterial(std::move(material)));
    }
}

struct TinyObj {
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
};

TinyObj loadTinyObj(const std::string& file, ObjText& checked) {
    TinyObj result;
    std::vector<tinyobj::material_t> materials;
    std::string warnings, errors;
    std::string names; // so that `usemtl N` becomes material N
    for (std::size_t k = 0; k < checked.materials.size(); ++k) names += fmt::format("newmtl {}\n", k);
    std::istringstream nameStream(std::move(names));
    tinyobj::MaterialStreamReader nameReader(nameStream);
    std::istringstream stream("mtllib names\n" + std::exchange(checked.statements, {}));
    if (!tinyobj::LoadObj(&result.attributes, &result.shapes, &materials, &warnings, &errors, &stream, &nameReader,
                          false, false))
        throw InputError(file + ": " + oneLine(errors));
    return result;
}

/// Calls a function with the name that was turned into a number, or "default" where there was none.
class NameTable {
public:
    template <typename Add>
    std::uint32_t index(int number, Add&& add) {
        const auto [entry, isNew] = indices_.try_emplace(number, 0);
        if (isNew) entry->second = add();
        return entry->second;
    }

private:
    std::map<int, std::uint32_t> indices_;
};

void addPolygons(SceneBuilder& builder, const TinyObj& source, const ObjText& checked,
                 std::map<std::string, std::uint32_t>& materials) {
    NameTable materialTable, nodeTable;
    std::vector<std::uint32_t> corners;
    std::size_t face = 0;
    for (const tinyobj::shape_t& shape : source.shapes) {
        const int group = shape.name.empty() ? -1 : std::stoi(shape.name);
        const std::uint32_t node = nodeTable.index(group, [&] {
            return builder.addNode(group < 0 ? "default" : checked.groups[static_cast<std::size_t>(group)]);
        });
        std::size_t begin = 0;
        for (std::size_t k = 0; k < shape.mesh.num_face_vertices.size(); ++k, ++face) {
            const auto wide = checked.wideFaces.find(face);
            const std::size_t size = wide != checked.wideFaces.end() ? wide->second : shape.mesh.num_face_vertices[k];
            corners.clear();
            for (std::size_t c = 0; c < size; ++c)
                corners.push_back(static_cast<std::uint32_t>(shape.mesh.indices[begin + c].vertex_index));
            begin += size;

            const int number = shape.mesh.material_ids[k];
            const std::uint32_t material = materialTable.index(number, [&] {
                const std::string name = number < 0 ? "default" : checked.materials[static_cast<std::size_t>(number)];
                const auto known = materials.find(name);
                if (known != materials.end()) return known->second;
                if (name != "default")
                    builder.warn(fmt::format("material {} is not defined: its reflectance is 0.5", inQuotes(name)));
                return materials.emplace(name, builder.addMaterial({.name = name})).first->second;
            });
            builder.addPolygon(corners, material, node);
        }
    }
}

} // namespace

ReadResult readObj(const std::filesystem::path& path, const ReadOptions& options) {
    if (!(options.metresPerUnit > 0.0) || !std::isfinite(options.metresPerUnit))
        throw UsageError(fmt::format("--unit: found {}, expected metres per unit of the file, a number above 0",
                                     options.metresPerUnit));
    const std::string file = path.string();
    ObjText checked = checkObj(file, readInputFile(path));

    SceneBuilder builder(file, options);
    std::map<std::string, std::uint32_t> materials;
    std::vector<std::filesystem::path> libraries;
    for (const std::string& argument : checked.libraries)
        for (const std::filesystem::path& library : libraryPaths(argument, path.parent_path()))
            if (std::find(libraries.begin(), libraries.end(), library) == libraries.end()) libraries.push_back(library);
    for (const std::filesystem::path& library : libraries) addLibrary(builder, library, materials);

    const TinyObj source = loadTinyObj(file, checked);
    const std::vector<float>& vertices = source.attributes.vertices;
    for (std::size_t k = 0; k + 2 < vertices.size(); k += 3)
        builder.addPosition(glm::dvec3(vertices[k], vertices[k + 1], vertices[k + 2]) * options.metresPerUnit);
    addPolygons(builder, source, checked, materials);
    if (checked.ignoredElements > 0)
        builder.warn(fmt::format("{} points or lines were ignored", checked.ignoredElements));
    return builder.finish();
}

} // namespace lambert
