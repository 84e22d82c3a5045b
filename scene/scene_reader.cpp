#include "scene/scene_reader.h"

#include "core/error.h"
#include "scene/input_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace lambert {

namespace {

struct Reader {
    std::string_view extension; //!< lower case
    ReadResult (*read)(const std::filesystem::path&, const ReadOptions&);
};

constexpr std::array kReaders{Reader{".obj", readObj}, Reader{".gltf", readGltf}, Reader{".glb", readGltf}};

/// The reader for a file's extension, or none.
const Reader* readerOf(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    const auto* const found = std::find_if(kReaders.begin(), kReaders.end(),
                                           [&](const Reader& reader) { return reader.extension == extension; });
    return found != kReaders.end() ? found : nullptr;
}

} // namespace

std::string sceneExtensions() {
    std::vector<std::string_view> names;
    for (const Reader& reader : kReaders) names.push_back(reader.extension);
    const std::string_view last = names.back();
    names.pop_back();
    return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

bool hasSceneExtension(const std::filesystem::path& path) { return readerOf(path) != nullptr; }

ReadResult readScene(const std::filesystem::path& path, const ReadOptions& options) {
    if (const Reader* reader = readerOf(path)) return reader->read(path, options);
    throw InputError(fmt::format("{}: found the extension {}, allowed are {}", path.string(),
                                 inQuotes(path.extension().string()), sceneExtensions()));
}

} // namespace lambert
