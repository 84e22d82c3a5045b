#pragma once

#include "scene/gltf/model.h"
#include "scene/reading.h"

#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <limits>
#include <string>

namespace lambert {

/// Reads a .gltf or .glb file with its buffers, and checks the container, the nesting and the type of every member that is
/// used (modelOf). Images are named but not read. The `extras` of the whole file, as they stand, go to where the
/// last argument points. Throws InputError with the file and, for the JSON part, the path of the member.
gltf::Model loadGltfModel(const std::filesystem::path& path, const ReadOptions& options,
                          nlohmann::json* extras = nullptr);

/// The folder that the files named in a scene are relative to.
std::filesystem::path gltfFolder(const std::filesystem::path& path);

/// Throws the InputError "FILE: PATH: found ..., allowed ...".
[[noreturn]] void failAtMember(const std::string& file, const std::string& member, const std::string& found,
                               const std::string& allowed);

/// `number` in single precision; `member` is its JSON path. Throws InputError if it is below 0 or above `largest`.
float checkedGltfNumber(const std::string& file, const std::string& member, double number,
                        double largest = std::numeric_limits<float>::max());

/// The element of a list of the document; `name` is the list's, `referrer` the JSON path of the member that holds
/// `index`. Throws InputError if there is none.
template <typename List>
auto& gltfElement(const std::string& file, List& list, const char* name, int index, const std::string& referrer) {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
        failAtMember(file, referrer, std::to_string(index),
                     list.empty() ? fmt::format("none: the file has no {}", name)
                                  : fmt::format("0 to {} ({})", list.size() - 1, name));
    return list[static_cast<std::size_t>(index)];
}

} // namespace lambert
