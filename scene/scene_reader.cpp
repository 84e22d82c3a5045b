#include "scene/scene_reader.h"

#include "core/error.h"
#include "scene/input_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace lambert {

ReadResult readScene(const std::filesystem::path& path, const ReadOptions& options) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (extension == ".obj") return readObj(path, options);
    if (extension == ".gltf" || extension == ".glb") return readGltf(path, options);
    if (extension == ".mgf") return readMgf(path, options);
    throw InputError(fmt::format("{}: found the extension {}, allowed are .obj, .gltf, .glb and .mgf", path.string(),
                                 inQuotes(path.extension().string())));
}

} // namespace lambert
