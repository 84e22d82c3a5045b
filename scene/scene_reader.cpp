#include "scene/scene_reader.h"

#include "core/error.h"
#include "scene/input_file.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace lambert {

namespace {

struct Format {
    std::string_view extension;
    ReadResult (*read)(const std::filesystem::path& path, const ReadOptions& options);
};

constexpr Format kFormats[] = {
    {".obj", readObj}, {".gltf", readGltf}, {".glb", readGltf}, {".ply", readPly}, {".stl", readStl}, {".mgf", readMgf},
};

} // namespace

ReadResult readScene(const std::filesystem::path& path, const ReadOptions& options) {
    if (!(options.metresPerUnit > 0.0) || !std::isfinite(options.metresPerUnit))
        throw UsageError(fmt::format("--unit: found {}, expected metres per unit of the file, a number above 0",
                                     options.metresPerUnit));
    const std::string extension = lowerCase(path.extension().string());
    std::string allowed;
    for (const Format& format : kFormats) {
        if (extension == format.extension) return format.read(path, options);
        allowed += fmt::format("{}{}", allowed.empty() ? "" : ", ", format.extension);
    }
    throw InputError(fmt::format("{}: found the extension {}, allowed are {}", path.string(),
                                 inQuotes(path.extension().string()), allowed));
}

} // namespace lambert
