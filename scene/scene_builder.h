#pragma once

#include "scene/scene_reader.h"

#include <glm/vec3.hpp>

#include <span>

namespace lambert {

/// What all readers share: takes what a file says and makes a Scene of triangles and convex planar quads of
/// it, counting and naming what has to be dropped or changed on the way.
class SceneBuilder {
public:
    /// `file` stands at the beginning of every message.
    SceneBuilder(std::string file, const ReadOptions& options);

    /// Adds a vertex, in metres, and returns its index. Coordinates that are not finite in single precision
    /// are allowed: the polygons that use them are dropped and counted.
    std::uint32_t addPosition(const glm::dvec3& metres);

    /// Adds a material and returns its index. Reflectance is clamped to [0, 0.99] and negative emission to 0,
    /// with one warning per material. The numbers must be finite.
    std::uint32_t addMaterial(Material material);

    /// Adds the name of a node and returns its index.
    std::uint32_t addNode(std::string name);

    void addCamera(Camera camera);

    /// Adds a polygon of the file, front counter-clockwise; the indices are what the other functions
    /// returned. Polygons with non-finite coordinates or without area are dropped; convex planar quads stay
    /// what they are; all others are split into triangles.
    void addPolygon(std::span<const std::uint32_t> vertices, std::uint32_t material, std::uint32_t node);

    /// Adds a line to the report.
    void warn(const std::string& text);

    /// The scene and the report; the builder is empty afterwards. Throws InputError if no polygon is left.
    ReadResult finish();

private:
    bool addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    bool addQuad();
    bool addSplit();
    bool append(const Polygon& polygon);

    std::string file_;
    bool twoSided_;
    ReadResult result_;
    std::size_t fans_ = 0;
    std::vector<std::uint32_t> corners_; //!< of the polygon at work, without repeated vertices
    std::uint32_t material_ = 0;         //!< of the polygon at work
    std::uint32_t node_ = 0;
};

} // namespace lambert
