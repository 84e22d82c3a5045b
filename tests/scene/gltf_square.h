#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace lambert {

/// The numbers as they lie in memory.
template <typename T>
std::string bytesOf(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

inline std::string base64(const std::string& bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        std::uint32_t bits = 0;
        for (std::size_t b = 0; b < 3; ++b)
            bits = bits << 8 | (k + b < bytes.size() ? static_cast<unsigned char>(bytes[k + b]) : 0U);
        for (std::size_t d = 0; d < 4; ++d) text += k + d <= bytes.size() ? kDigits[bits >> (18 - 6 * d) & 63] : '=';
    }
    return text;
}

/// A .glb file.
inline std::string glb(const nlohmann::json& document, std::string binary) {
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const auto word = [](std::size_t value) { return bytesOf(std::vector{static_cast<std::uint32_t>(value)}); };
    std::string chunks = word(text.size()) + "JSON" + text;
    if (!binary.empty()) chunks += word(binary.size()) + std::string("BIN\0", 4) + binary;
    return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

/// A unit square of four vertices (48 bytes) with six 16-bit indices (12 bytes), one node, one material.
struct Square {
    std::string binary =
        bytesOf<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + bytesOf<std::uint16_t>({0, 1, 2, 0, 2, 3});
    nlohmann::json document = nlohmann::json::parse(R"({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "square", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"name": "white", "pbrMetallicRoughness":
                       {"baseColorFactor": [0.5, 0.25, 0.125, 1], "metallicFactor": 0}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"byteLength": 60}]})");

    /// Appends a buffer view of these bytes and returns its index.
    int addView(const std::string& bytes) {
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}});
        binary += bytes;
        document["buffers"][0]["byteLength"] = binary.size();
        return static_cast<int>(document["bufferViews"].size() - 1);
    }

    /// Appends an accessor of `count` elements, packed one after the other, and returns its index.
    int addAccessor(const std::string& bytes, int componentType, const std::string& type, std::size_t count,
                    bool normalised = false) {
        const int view = addView(bytes);
        document["accessors"].push_back({{"bufferView", view},
                                         {"componentType", componentType},
                                         {"type", type},
                                         {"count", count},
                                         {"normalized", normalised}});
        return static_cast<int>(document["accessors"].size() - 1);
    }

    nlohmann::json& operator[](const std::string& pointer) { return document[nlohmann::json::json_pointer(pointer)]; }
};

} // namespace lambert
