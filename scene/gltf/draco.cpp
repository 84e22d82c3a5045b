// KHR_draco_mesh_compression: https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_draco_mesh_compression
// Draco bitstream 2.2: https://google.github.io/draco/spec/

#include "scene/gltf/draco.h"

#include "core/error.h"
#include "core/text.h"
#include "scene/gltf/buffers.h"
#include "scene/gltf/document.h"

#include <draco/compression/config/decoder_options.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <fmt/format.h>

#include <cstring>
#include <span>
#include <stdexcept>
#include <vector>

namespace lambert {

namespace {

// A regular grid of 2 million triangles takes Draco's encoder 1 byte for 40 of them.
constexpr std::uint64_t kMostPerByte = 256;         //!< triangles, or points
constexpr std::uint64_t kMostBytesPerPoint = 1024;  //!< of all attributes; those that glTF names have less than 300
constexpr std::uint64_t kMostElements = 1ULL << 26; //!< triangles, or points, of a whole file

/// Draco's decoders allocate what a stream announces before they look for it. These stop before that.
template <typename Base>
class GuardedDecoder : public Base {
public:
    GuardedDecoder(std::size_t streamSize, std::uint64_t mostElements)
        : mostElements_(std::min(streamSize * kMostPerByte, mostElements)) {}

private:
    static constexpr bool kIsEdgebreaker = std::is_same_v<Base, draco::MeshEdgebreakerDecoder>;

    bool DecodeConnectivity() override {
        draco::DecoderBuffer ahead = *this->buffer();
        if constexpr (kIsEdgebreaker) ahead.Advance(1); // the kind of traversal
        std::uint32_t first = 0, second = 0;            // points and triangles, or triangles and points
        if (!draco::DecodeVarint(&first, &ahead) || !draco::DecodeVarint(&second, &ahead)) return false;
        if (first > mostElements_ || second > mostElements_) return false;
        return Base::DecodeConnectivity();
    }

    bool DecodeAllAttributes() override {
        const draco::PointCloud& points = *this->point_cloud();
        if (points.num_points() > 3 * mostElements_) return false;
        std::uint64_t bytes = 0;
        for (std::int32_t k = 0; k < points.num_attributes(); ++k) {
            const draco::PointAttribute& attribute = *points.attribute(k);
            const auto size = static_cast<std::uint64_t>(draco::DataTypeLength(attribute.data_type()));
            bytes += attribute.num_components() * std::max<std::uint64_t>(size, 4); // decoded by way of 4 bytes
        }
        return bytes <= kMostBytesPerPoint && Base::DecodeAllAttributes();
    }

    std::uint64_t mostElements_;
};

/// Throws std::runtime_error with the reason.
void decode(std::span<const unsigned char> bytes, std::uint64_t mostElements, draco::Mesh& mesh) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DecoderBuffer head = buffer;
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&head, &header).ok()) throw std::runtime_error("no Draco header");
    if (header.version_major != 2 || header.version_minor != 2)
        throw std::runtime_error(
            fmt::format("Draco bitstream {}.{}", unsigned{header.version_major}, unsigned{header.version_minor}));
    if (header.encoder_type != draco::TRIANGULAR_MESH) throw std::runtime_error("a point cloud");

    const draco::DecoderOptions options;
    const auto run = [&](auto&& decoder) { return decoder.Decode(options, &buffer, &mesh); };
    const draco::Status status = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING
                                     ? run(GuardedDecoder<draco::MeshEdgebreakerDecoder>(bytes.size(), mostElements))
                                     : run(GuardedDecoder<draco::MeshSequentialDecoder>(bytes.size(), mostElements));
    if (!status.ok()) throw std::runtime_error(status.error_msg_string());
}

/// The values of an attribute, one after the other, as numbers of the type T.
template <typename T>
std::vector<unsigned char> valuesAs(const draco::PointAttribute& attribute, std::uint32_t points,
                                    std::size_t components) {
    if (!attribute.is_mapping_identity() && attribute.indices_map_size() < points)
        throw std::runtime_error("an attribute with fewer values than points");
    std::vector<unsigned char> bytes(points * components * sizeof(T));
    std::vector<T> value(components);
    for (std::uint32_t k = 0; k < points; ++k) {
        const draco::AttributeValueIndex index = attribute.mapped_index(draco::PointIndex(k));
        if (index.value() >= attribute.size() ||
            !attribute.ConvertValue<T>(index, static_cast<std::int8_t>(components), value.data()))
            throw std::runtime_error("an attribute value that cannot be converted");
        std::memcpy(bytes.data() + k * components * sizeof(T), value.data(), components * sizeof(T));
    }
    return bytes;
}

std::vector<unsigned char> values(const draco::PointAttribute& attribute, std::uint32_t points,
                                  const gltf::Accessor& accessor) {
    switch (accessor.componentType) {
    case gltf::ComponentType::Byte:
        return valuesAs<std::int8_t>(attribute, points, accessor.components);
    case gltf::ComponentType::UnsignedByte:
        return valuesAs<std::uint8_t>(attribute, points, accessor.components);
    case gltf::ComponentType::Short:
        return valuesAs<std::int16_t>(attribute, points, accessor.components);
    case gltf::ComponentType::UnsignedShort:
        return valuesAs<std::uint16_t>(attribute, points, accessor.components);
    case gltf::ComponentType::Float:
        return valuesAs<float>(attribute, points, accessor.components);
    default:
        throw std::runtime_error("an attribute for an accessor of another type");
    }
}

std::vector<unsigned char> triangleCorners(const draco::Mesh& mesh) {
    std::vector<std::uint32_t> corners;
    corners.reserve(3 * std::size_t{mesh.num_faces()});
    for (std::uint32_t k = 0; k < mesh.num_faces(); ++k)
        for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(k))) {
            if (point.value() >= mesh.num_points()) throw std::runtime_error("a triangle of points that are not there");
            corners.push_back(point.value());
        }
    std::vector<unsigned char> bytes(corners.size() * sizeof(std::uint32_t));
    if (!corners.empty()) std::memcpy(bytes.data(), corners.data(), bytes.size());
    return bytes;
}

int addAccessor(gltf::Model& model, gltf::Accessor accessor, std::size_t count, std::vector<unsigned char> bytes) {
    accessor.bufferView = static_cast<int>(model.bufferViews.size());
    accessor.byteOffset = 0;
    accessor.count = count;
    accessor.sparse.reset();
    model.accessors.push_back(std::move(accessor));
    model.bufferViews.push_back({.buffer = static_cast<int>(model.buffers.size()), .byteLength = bytes.size()});
    model.buffers.push_back(std::move(bytes));
    return static_cast<int>(model.accessors.size() - 1);
}

bool isRead(const std::string& attribute) {
    return attribute == "POSITION" || attribute.starts_with("TEXCOORD_") || attribute.starts_with("COLOR_");
}

class Decompression {
public:
    Decompression(const std::string& file, gltf::Model& model) : file_(file), model_(model) {}

    void run(gltf::Primitive& primitive, const gltf::Draco& source, const std::string& place) {
        const auto bytes = gltfViewBytes(file_, model_, source.bufferView, place + "/bufferView");
        draco::Mesh mesh;
        try {
            decode(bytes, left_, mesh);
            replace(primitive, source.attributes, place, mesh);
        } catch (const InputError&) {
            throw;
        } catch (const std::exception& error) { // also what containers inside the library throw
            failAtMember(file_, place, fmt::format("data that cannot be decompressed ({})", oneLine(error.what(), 100)),
                         "a mesh compressed by Draco, bitstream 2.2");
        }
    }

private:
    void replace(gltf::Primitive& primitive, const std::map<std::string, int>& ids, const std::string& place,
                 const draco::Mesh& mesh) {
        left_ -= std::min<std::uint64_t>(left_, std::max(mesh.num_faces(), mesh.num_points()));
        for (auto& [name, accessor] : primitive.attributes) {
            const auto id = ids.find(name);
            if (!isRead(name) || id == ids.end()) continue;
            const auto* attribute = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id->second));
            if (attribute == nullptr)
                failAtMember(file_, fmt::format("{}/attributes/{}", place, oneLine(name, 60)),
                             std::to_string(id->second), "the id of an attribute in the compressed data");
            const gltf::Accessor source =
                gltfElement(file_, model_.accessors, "accessors", accessor, place + "/attributes/" + oneLine(name, 60));
            accessor = addAccessor(model_, source, mesh.num_points(), values(*attribute, mesh.num_points(), source));
        }
        gltf::Accessor indices{.componentType = gltf::ComponentType::UnsignedInt, .type = "SCALAR", .components = 1};
        primitive.indices =
            addAccessor(model_, std::move(indices), 3 * std::size_t{mesh.num_faces()}, triangleCorners(mesh));
        primitive.mode = gltf::kTriangles; // strips too are compressed as triangles
    }

    const std::string& file_;
    gltf::Model& model_;
    std::uint64_t left_ = kMostElements;
};

} // namespace

void decompressDraco(const std::string& file, gltf::Model& model) {
    Decompression decompression(file, model);
    for (std::size_t m = 0; m < model.meshes.size(); ++m)
        for (std::size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
            gltf::Primitive& primitive = model.meshes[m].primitives[p];
            if (primitive.draco)
                decompression.run(primitive, *primitive.draco,
                                  fmt::format("/meshes/{}/primitives/{}/extensions/KHR_draco_mesh_compression", m, p));
        }
}

} // namespace lambert
