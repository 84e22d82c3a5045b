#pragma once

#include "scene/gltf/model.h"
#include "scene/scene_builder.h"

#include <glm/mat3x2.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace lambert {

/// Where a texture lies on a mesh.
struct GltfTextureCoordinates {
    int set = 0;            //!< of TEXCOORD_n
    glm::mat3x2 toUv{1.0F}; //!< from these coordinates, with 1 appended, to the texture's (KHR_texture_transform)
    bool operator==(const GltfTextureCoordinates&) const = default;
};

/// A texture of a material, as the file has it.
struct GltfTexture {
    int image = 0; //!< into the model's images
    TextureWrap wrapU = TextureWrap::Repeat, wrapV = TextureWrap::Repeat;
    GltfTextureCoordinates coordinates;

    /// Whether another texture's texels lie on the same points of the mesh, but for the size of the images.
    bool coversTheSameAs(const GltfTexture& other) const {
        return wrapU == other.wrapU && wrapV == other.wrapV && coordinates == other.coordinates;
    }
};

/// The textures of a model: finds what a material names, and reads its images.
class GltfTextures {
public:
    GltfTextures(const std::string& file, const std::filesystem::path& folder, const gltf::Model& model,
                 SceneBuilder& builder)
        : file_(file), folder_(folder), model_(model), builder_(builder) {}

    /// The texture that a textureInfo object, which stands at `place`, names; none if it names none, or, with a warning
    /// that ends in `replacement` or an InputError under ReadOptions::strict, none in a format that Lambert reads. Throws
    /// InputError with the JSON path if an index is out of range.
    std::optional<GltfTexture> find(const gltf::TextureInfo& info, const std::string& place,
                                    const std::string& replacement);

    /// The colours of its image; null as in SceneBuilder::readTextureFile. An image is read only once.
    std::shared_ptr<const Texture> colours(const GltfTexture& texture, const std::string& replacement);
    /// The numbers of its image as they are, read anew each time; null as above.
    std::shared_ptr<const Texture> numbers(const GltfTexture& texture, const std::string& replacement);
    /// The index of the texture's colours in the scene, which are not null.
    std::uint32_t addColours(const GltfTexture& texture);

private:
    int imageOf(int texture, const std::string& replacement);
    std::shared_ptr<const Texture> read(int image, TextureContent content, const std::string& replacement);

    std::string file_;
    std::filesystem::path folder_;
    const gltf::Model& model_;
    SceneBuilder& builder_;
    std::map<int, std::shared_ptr<const Texture>> colours_; //!< by image
    std::map<int, std::uint32_t> added_;                    //!< by image: its index in the scene
};

} // namespace lambert
