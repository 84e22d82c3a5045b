#pragma once

#include "scene/gltf/container.h"
#include "scene/gltf/model.h"
#include "scene/reading.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace lambert {

/// The content of all buffers of a document: of the .glb, of data URIs and of files named relative to `folder`. Empty
/// where the buffer only stands for decompressed data. Throws InputError with `file` and the JSON path if one is
/// missing, outside of what `options` allow, or shorter than its `byteLength`.
std::vector<gltf::Buffer> readGltfBuffers(const std::string& file, const std::filesystem::path& folder,
                                          const GltfContainer& container,
                                          const std::vector<gltf::BufferSource>& sources, const ReadOptions& options);

/// `length` bytes of a buffer from `offset` on. `place` is the JSON path of the object that holds these numbers and the
/// buffer's index. Throws InputError if they are not all there.
std::span<const unsigned char> gltfBytes(const std::string& file, const gltf::Model& model, int buffer,
                                         std::size_t offset, std::size_t length, const std::string& place);

/// The bytes of a buffer view. `referrer` is the JSON path of the member that holds its index. Throws InputError.
std::span<const unsigned char> gltfViewBytes(const std::string& file, const gltf::Model& model, int view,
                                             const std::string& referrer);

} // namespace lambert
