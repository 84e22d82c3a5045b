#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// What Lambert uses of a glTF 2.0 document, under the format's names and with its defaults. Unless a comment says more, an
/// int is an index into a list of the model, which may be shorter, or -1 where the document has none.
namespace lambert::gltf {

using Buffer = std::vector<unsigned char>; ///< its bytes

/// Where they come from.
struct BufferSource {
    std::optional<std::string> uri{};
    std::size_t byteLength = 0;
    bool isFallback = false; //!< all its views are compressed: it has no data of its own
};

/// Of a compressed buffer view (EXT_meshopt_compression).
struct Meshopt {
    std::string extension; //!< its name in the file
    int buffer = -1;
    std::size_t byteOffset = 0, byteLength = 0, byteStride = 0, count = 0;
    std::string mode, filter = "NONE";
};

struct BufferView {
    int buffer = -1;
    std::size_t byteOffset = 0, byteLength = 0;
    std::size_t byteStride = 0; //!< 0: element follows on element
    std::optional<Meshopt> meshopt{};
};

/// Also other values, which Lambert does not read.
enum class ComponentType : int { Byte = 5120, UnsignedByte, Short, UnsignedShort, Int, UnsignedInt, Float };

/// The elements of an accessor that stand elsewhere than in its buffer view.
struct Sparse {
    struct Part {
        int bufferView = -1;
        std::size_t byteOffset = 0;
    };
    std::size_t count = 0;
    Part indices{}, values{};
    ComponentType indexType = ComponentType::UnsignedInt;
};

struct Accessor {
    int bufferView = -1; //!< -1: all elements are 0
    std::size_t byteOffset = 0, count = 0;
    ComponentType componentType = ComponentType::Float;
    std::string type;           //!< SCALAR, VEC2 to VEC4, or MAT2 to MAT4
    std::size_t components = 0; //!< of an element
    bool normalized = false;
    std::optional<Sparse> sparse{};
};

/// Of a compressed primitive (KHR_draco_mesh_compression).
struct Draco {
    int bufferView = -1;
    std::map<std::string, int> attributes; //!< ids in the compressed data
};

/// Modes; those below are points and lines.
inline constexpr int kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6;

struct Primitive {
    std::map<std::string, int> attributes; //!< accessors
    int indices = -1, material = -1;
    int mode = kTriangles; //!< any number
    bool hasTargets = false;
    std::optional<Draco> draco{};
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
};

/// A texture as a material uses it.
struct TextureInfo {
    int index = -1;
    int texCoord = 0;                   //!< n of TEXCOORD_n
    glm::dvec2 offset{0.0}, scale{1.0}; //!< of KHR_texture_transform
    double rotation = 0.0;              //!< of KHR_texture_transform, radians
};

/// KHR_materials_pbrSpecularGlossiness
struct SpecularGlossiness {
    glm::dvec4 diffuseFactor{1.0};
    TextureInfo diffuseTexture;
};

/// Colours and factors are linear; any numbers.
struct Material {
    std::string name;
    bool doubleSided = false;
    std::string alphaMode = "OPAQUE"; //!< any text
    double alphaCutoff = 0.5;
    glm::dvec4 baseColorFactor{1.0};
    double metallicFactor = 1.0;
    glm::dvec3 emissiveFactor{0.0};
    TextureInfo baseColorTexture, metallicRoughnessTexture, emissiveTexture;
    double emissiveStrength = 1.0;   //!< KHR_materials_emissive_strength
    double transmissionFactor = 0.0; //!< KHR_materials_transmission
    bool isUnlit = false;            //!< KHR_materials_unlit
    std::optional<SpecularGlossiness> specularGlossiness{};
};

struct Texture {
    int sampler = -1;
    int source = -1;       //!< an image
    int webpSource = -1;   //!< an image: EXT_texture_webp
    bool hasBasis = false; //!< KHR_texture_basisu
};

/// The file `uri`, which may be a data URI, or else a buffer view.
struct Image {
    std::string name, uri;
    int bufferView = -1;
};

struct Sampler {
    int wrapS = 10497, wrapT = 10497; //!< OpenGL's numbers; any
};

struct Camera {
    std::string name, type; //!< type: perspective or orthographic
    double yfov = 0.0;      //!< of perspective, radians; any number
};

/// KHR_lights_punctual; any numbers.
struct Light {
    std::string name, type;
    glm::dvec3 color{1.0};
    double intensity = 1.0;                                     //!< candela; of directional lights lux
    double innerConeAngle = 0.0, outerConeAngle = 0.7853981634; //!< of spots, radians
};

struct Node {
    std::string name;
    std::vector<int> children;
    int mesh = -1, camera = -1, light = -1;
    bool hasSkin = false;
    std::optional<glm::dmat4> matrix{}; //!< instead of the three:
    glm::dvec3 translation{0.0};
    glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0}; //!< x, y, z, w; of any length
    glm::dvec3 scale{1.0};
    std::map<std::string, int> instances; //!< accessors by attribute (EXT_mesh_gpu_instancing)
};

struct Scene {
    std::string name;
    std::vector<int> nodes;
};

struct Model {
    std::vector<std::string> extensionsRequired;
    std::vector<BufferSource> bufferSources;
    std::vector<Buffer> buffers; //!< those, then decompressed ones
    std::vector<BufferView> bufferViews;
    std::vector<Accessor> accessors;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Image> images;
    std::vector<Sampler> samplers;
    std::vector<Camera> cameras;
    std::vector<Light> lights;
    std::vector<Node> nodes;
    std::vector<Scene> scenes;
    int scene = -1;
};

/// All of a document but what its buffers hold. Checks that every member that is used has the right type, and that required ones
/// are there: throws InputError with `file` and the JSON path. Does not check that an index is below the length of its list.
Model modelOf(const std::string& file, const nlohmann::json& document);

} // namespace lambert::gltf
