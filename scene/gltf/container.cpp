#include "scene/gltf/container.h"

#include "core/error.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>

namespace lambert {

namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

std::uint32_t word(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value); // glTF is little-endian, as are our machines
    return value;
}

} // namespace

GltfContainer unpackGltf(const std::string& file, std::string_view bytes) {
    if (!bytes.starts_with("glTF")) return {bytes, {}, false};
    const auto fail = [&](const std::string& what) { throw InputError(fmt::format("{}: {}", file, what)); };
    if (bytes.size() < 20) fail(fmt::format("found {} bytes, a .glb has at least 20", bytes.size()));
    if (word(bytes, 4) != 2) fail(fmt::format("found glTF binary version {}, allowed is 2", word(bytes, 4)));
    const std::size_t length = word(bytes, 8);
    if (length > bytes.size())
        fail(fmt::format("found {} bytes, but its header announces {}: is the file cut?", bytes.size(), length));
    if (length < 20) fail(fmt::format("its header announces {} bytes, a .glb has at least 20", length));
    bytes = bytes.substr(0, length);

    GltfContainer container{{}, {}, true};
    for (std::size_t offset = 12; offset + 8 <= bytes.size();) {
        const std::size_t size = word(bytes, offset);
        const std::uint32_t type = word(bytes, offset + 4);
        const std::size_t left = bytes.size() - offset - 8;
        if (size > left)
            fail(fmt::format("the chunk at byte {} has length {}, allowed at most {}", offset, size, left));
        if (offset == 12) {
            if (type != kJsonChunk) fail("its first chunk is not JSON");
            container.jsonText = bytes.substr(offset + 8, size);
        } else if (type == kBinaryChunk && container.binary.empty()) {
            container.binary = bytes.substr(offset + 8, size);
        }
        offset += 8 + size;
    }
    return container;
}

} // namespace lambert
