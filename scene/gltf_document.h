#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tinygltf {
class Model;
}

namespace lambert {

/// Reads a .gltf or .glb file with its buffers into tinygltf's structures. What tinygltf does not check is
/// checked before it sees the file: container, nesting, the type of every member that the reader uses
/// (checkGltfMembers), buffer sizes. Images, animations, skins, extensions of the whole file and `extras` are
/// left out. Throws InputError with the file and, for the JSON part, the path of the member.
tinygltf::Model loadGltfModel(const std::filesystem::path& path);

/// The path that a URI stands for: %20 becomes a space.
std::string decodedUri(std::string_view uri);

/// Throws the InputError "FILE: PATH: found ..., allowed ...".
[[noreturn]] void failAtMember(const std::string& file, const std::string& member, const std::string& found,
                               const std::string& allowed);

} // namespace lambert
