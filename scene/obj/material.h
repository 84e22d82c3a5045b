#pragma once

#include "scene/obj/mtl.h"
#include "scene/scene_builder.h"

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace lambert {

/// Where the texture coordinate (u, v) of an OBJ file, v upwards, lies in the image.
struct ObjUvTransform {
    glm::vec2 scale{1.0F};
    glm::vec2 offset{0.0F};

    glm::vec2 operator()(const glm::vec2& uv) const {
        const glm::vec2 moved = uv * scale + offset;
        return {moved.x, 1.0F - moved.y};
    }
};

/// What the polygons of one `usemtl` need.
struct ObjMaterial {
    std::uint32_t index = 0; //!< SceneBuilder's
    bool textured = false;   //!< needs texture coordinates
    bool tinted = false;     //!< takes the vertices' colours
    ObjUvTransform uv{}, emissionUv{};
};

/// What polygons without `usemtl` look for.
inline constexpr const char* kNoMaterial = "default";

/// Where nothing tells the reflectance.
inline constexpr float kUnknownReflectance = 0.5F;

/// The materials of an OBJ file, by name: those of its libraries, and a substitute for every other.
class ObjMaterials {
public:
    /// `folder` is the OBJ file's. With `vertexColours`, substitutes are tinted by them.
    ObjMaterials(SceneBuilder& builder, const ReadOptions& options, std::filesystem::path folder, bool vertexColours);

    /// Adds what `mtllib` with this argument means: one file with spaces in its name, or several. Of materials with
    /// the same name the first counts. Throws InputError for malformed libraries, and under `strict` for missing ones.
    void addLibraries(const std::string& argument);

    /// The material of `usemtl name`, its name in UTF-8; of polygons without one kNoMaterial.
    const ObjMaterial& find(const std::string& name);

    /// Warns, once for all materials, of what was found in the libraries and is not used as it stands.
    void warnOfReplacements();

private:
    void addLibrary(const std::string& name);
    bool isFile(const std::string& name) const;
    void addMaterial(const MtlMaterial& source);
    void setReflectance(const MtlMaterial& source, Material& material, ObjMaterial& use);
    void setEmission(const MtlMaterial& source, Material& material, ObjMaterial& use);
    void setOpacity(const MtlMaterial& source, Material& material, ObjMaterial& use);
    Rgb mapFactor(const MtlMaterial& source, const std::optional<Rgb>& colour, const MtlMap& map,
                  std::vector<std::string>& blackOnes);
    ObjMaterial addSubstitute(const std::string& name);

    SceneBuilder& builder_;
    const ReadOptions& options_;
    std::filesystem::path folder_;
    bool vertexColours_;
    std::set<std::filesystem::path> libraries_; //!< already read
    std::unordered_map<std::string, ObjMaterial> materials_;
    std::size_t undefined_ = 0;
    // Names of materials that share a warning:
    std::vector<std::string> notDiffuse_, blackReflectance_, blackEmission_, shiftedMaps_, otherOpacityUv_;
};

} // namespace lambert
