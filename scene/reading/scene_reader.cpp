#include "scene/reading/scene_reader.h"

#include "core/error.h"
#include "core/text.h"
#include "scene/readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace lambert {

namespace {

struct Reader {
    std::string_view extension; //!< lower case
    ReadResult (*read)(const std::filesystem::path&, const ReadOptions&);
};

constexpr std::array kReaders{Reader{".gltf", readGltf}, Reader{".glb", readGltf}, Reader{".obj", readObj},
                              Reader{".ply", readPly},   Reader{".stl", readStl},  Reader{".mgf", readMgf}};

/// The reader for a file's extension, or none.
const Reader* readerOf(const std::filesystem::path& path) {
    const std::string extension = lowerCase(path.extension().string());
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
    if (!(options.metresPerUnit > 0.0) || !std::isfinite(options.metresPerUnit))
        throw UsageError(fmt::format("--unit: found {}, expected metres per unit of the file, a number above 0",
                                     options.metresPerUnit));
    if (const Reader* reader = readerOf(path)) {
        Progress silent;
        ReadOptions placed = options;
        if (placed.progress == nullptr) placed.progress = &silent;
        ReadResult result = reader->read(path, placed);
        const glm::dvec3 needed = result.report.neededOrigin;
        if (needed == glm::dvec3(0.0)) return result;
        result = {};
        placed.origin = needed;
        return reader->read(path, placed);
    }
    throw InputError(fmt::format("{}: found the extension {}, allowed are {}", path.string(),
                                 inQuotes(path.extension().string()), sceneExtensions()));
}

} // namespace lambert
