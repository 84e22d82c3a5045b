#pragma once

#include "scene/distant_origin.h"
#include "scene/reading.h"

#include <glm/vec3.hpp>

#include <filesystem>
#include <map>
#include <span>
#include <string>

namespace lambert {

/// A factor of textures or tints: up to white it is brought to the largest reflectance, so that white, which is what most
/// such factors are, needs no warning; beyond white it stays, for SceneBuilder::addMaterial to warn.
Rgb notAboveLargest(const Rgb& factor);

/// Of one polygon in a file: splitting it takes time that may grow with the square.
inline constexpr std::size_t kMostPolygonCorners = std::size_t{1} << 16;

/// What all readers share: takes what a file says and makes a Scene of triangles and convex planar quads of
/// it, counting and naming what has to be dropped or changed on the way.
class SceneBuilder {
public:
    /// `file` stands at the beginning of every message.
    SceneBuilder(std::string file, const ReadOptions& options);

    /// Allows one more polygon for each of these bytes that the scene's file names, such as a buffer's; the file's own are
    /// counted already. See ReadOptions::mostPolygons.
    void countBytes(std::uintmax_t bytes) { bytes_ += bytes; }

    /// The polygons that are allowed with the bytes counted so far; addPolygon throws InputError beyond.
    std::uintmax_t mostPolygons() const;

    /// Takes the memory for this many, so that growing does not need it twice. More or fewer may follow.
    void reserve(std::size_t positions, std::size_t polygons);

    /// The place in the scene of one in the file, in metres; see Scene::origin.
    glm::vec3 local(const glm::dvec3& metres) const { return placeInScene(result_.scene, metres); }

    /// Adds a vertex, in metres of the file, and returns its index. Coordinates that are not finite in single precision
    /// are allowed: the polygons that use them are dropped and counted.
    std::uint32_t addPosition(const glm::dvec3& metres);

    /// Tells that the file has these coordinates in single precision, in units of `metres`; see warnOfRounding.
    void noteSinglePrecision(const glm::vec3& stored, double metres);

    /// Adds a material and returns its index. Reflectance is clamped to [0, 0.99], emission to
    /// [0, 1e30], with one warning per material. The numbers must be finite.
    std::uint32_t addMaterial(Material material);

    /// Adds the name of a node and returns its index.
    std::uint32_t addNode(std::string name);

    void addCamera(Camera camera) { result_.scene.cameras.push_back(std::move(camera)); }
    void addLight(PunctualLight light) { result_.scene.lights.push_back(std::move(light)); }

    /// Adds an image and returns its index; the same file and content is read only once. If it cannot be used: kNone and
    /// a warning that ends in `replacement` ("the material's constant reflectance is used"), or InputError under `strict`.
    /// `name` is as the scene's file has it, relative to `folder`.
    std::uint32_t addTextureFile(const std::filesystem::path& folder, const std::string& name, TextureContent content,
                                 const std::string& replacement);
    /// The same image without adding it; null where the function above returns kNone.
    std::shared_ptr<const Texture> readTextureFile(const std::filesystem::path& folder, const std::string& name,
                                                   TextureContent content, const std::string& replacement);
    /// The same of an image inside the scene's file.
    std::shared_ptr<const Texture> readTextureBytes(std::span<const std::uint8_t> bytes, const std::string& name,
                                                    TextureContent content, const std::string& replacement);
    /// Adds an image that a reader made.
    std::uint32_t addTexture(std::shared_ptr<const Texture> texture);

    /// What varies over a polygon, at one corner; see SurfaceCorners.
    struct CornerSurface {
        glm::vec2 uv{0.0F}, emissionUv{0.0F};
        Rgb tint{1.0F};
    };
    /// Adds a polygon of the file, front counter-clockwise; the indices are what the other functions returned. Polygons with
    /// non-finite coordinates or without area are dropped; convex planar quads stay what they are; all others are split into
    /// triangles. `surface` (#vertices, or none) is at the corners: coordinates or tints that are not finite count as 0.
    void addPolygon(std::span<const std::uint32_t> vertices, std::uint32_t material, std::uint32_t node,
                    std::span<const CornerSurface> surface = {});

    /// Adds a planar polygon with holes: the corners of the border (front counter-clockwise) and of each hole, one loop
    /// after the other, `loopSizes` many each. A loop may also take in holes by seams, edges that it goes there and back.
    /// False if loops cross or lie outside the border, so that the border was filled instead.
    bool addPolygonWithHoles(std::span<const std::uint32_t> vertices, std::span<const std::size_t> loopSizes,
                             std::uint32_t material, std::uint32_t node);

    /// Polygons added so far, after splitting.
    std::size_t polygonCount() const { return result_.scene.polygons.size(); }

    /// Adds a line to the report.
    void warn(const std::string& text);
    /// Adds a line to the report, or throws it as InputError under `strict`: for what the scene names but does not have.
    void warnUnlessStrict(const std::string& text);

    /// The scene and the report; the builder is empty afterwards. Throws InputError if no polygon is left, or nothing larger
    /// than 1e-10 m, unless another origin is needed (see ReadReport::neededOrigin).
    ReadResult finish();

private:
    void requireFewerThan(std::uintmax_t most, std::size_t count, const char* what) const;
    bool addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c); //!< into corners_
    bool addQuad();
    bool addSplit();
    void growBounds(std::span<const std::uint32_t> vertices);
    void warnOfRounding();

    std::uint32_t cornerSurface(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
    template <typename Read>
    std::shared_ptr<const Texture> textureOrNull(const std::string& name, const std::string& replacement, Read&& read);

    std::string file_;
    ReadOptions options_;
    std::uintmax_t bytes_ = 0; //!< of the scene's files
    ReadResult result_;
    std::vector<glm::vec3> rounding_; //!< #positions: what single precision lost of them; until the origin is known
    PlaceBounds bounds_;              //!< of the vertices that polygons use
    double coarsest_ = 0.0;           //!< metres: distance of neighbouring numbers where the file has single precision
    std::map<std::string, std::uint32_t> textures_;
    std::size_t fans_ = 0;
    std::size_t droppedFans_ = 0;
    // Of the polygon at work, without repeated vertices:
    std::vector<std::uint32_t> corners_; //!< the vertices
    std::vector<CornerSurface> surface_; //!< #corners_, or empty
    std::uint32_t material_ = 0;
    std::uint32_t node_ = 0;
};

} // namespace lambert
