#pragma once

#include <string>
#include <string_view>

namespace lambert {

/// The parts of a .gltf or .glb file, inside its bytes.
struct GltfContainer {
    std::string_view jsonText;
    std::string_view binary; //!< of a .glb; may be empty
    bool isBinary = false;
};

/// Takes a file apart. Throws InputError with `file` if a .glb's header or chunks do not fit its size.
GltfContainer unpackGltf(const std::string& file, std::string_view bytes);

} // namespace lambert
