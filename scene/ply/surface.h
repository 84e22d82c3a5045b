#pragma once

#include "scene/ply/header.h"
#include "scene/ply/records.h"
#include "scene/scene_builder.h"

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lambert {

/// Reads the colour that the records of an element may have, as a tint of a material whose reflectance is kMaxReflectance.
class PlyTints {
public:
    explicit PlyTints(const PlyElement& element);

    bool present() const { return present_; }
    /// Of the record last read. Integers are taken as encoded in sRGB, 0 to 255 (65535 if they are `ushort`), real numbers
    /// as linear, 0 to 1.
    Rgb read(const PlyRecords& record);
    std::size_t clampedCount() const { return clamped_; } //!< of colours read outside [0, kMaxReflectance]

private:
    bool present_ = false;
    std::array<std::size_t, 3> columns_{};
    std::array<double, 3> largest_{}; //!< of integers; 0: a real number
    std::size_t clamped_ = 0;
};

/// What varies over the surface, at each vertex; one or both may be empty.
struct PlyVertexSurface {
    std::vector<Rgb> tints;
    std::vector<glm::vec2> coordinates; //!< of textures
};

/// Gathers what varies over a face from the face and its vertices. What the face has itself counts first.
class PlyFaceSurface {
public:
    /// `images`: how many images the file names. `vertices` must outlive this.
    PlyFaceSurface(const PlyElement& face, const PlyVertexSurface& vertices, std::size_t images);

    bool hasTints() const { return tints_.present() || !vertices_.tints.empty(); }
    bool hasCoordinates() const { return coordinates_ || !vertices_.coordinates.empty(); }

    /// Takes what the record last read has for its `corners`, each smaller than the number of vertices. Throws InputError
    /// if it is inconsistent.
    void read(const PlyRecords& face, std::span<const std::uint32_t> corners);

    /// Of the face last read: what varies at its corners; empty: nothing.
    std::span<const SceneBuilder::CornerSurface> corners() const { return corners_; }
    /// Of the face last read: its image; kNone: it has none.
    std::uint32_t image() const { return image_; }
    std::size_t clampedCount() const { return tints_.clampedCount(); }

private:
    void readCoordinates(const PlyRecords& face, std::span<const std::uint32_t> corners);

    const PlyVertexSurface& vertices_;
    std::size_t images_;
    PlyTints tints_;
    std::optional<std::size_t> coordinates_; //!< a list: u and v of each corner
    std::optional<std::size_t> imageNumber_;
    std::vector<SceneBuilder::CornerSurface> corners_;
    std::uint32_t image_ = kNone;
};

/// PLY's v grows upwards, a texture's downwards.
inline glm::vec2 plyTextureCoordinates(double u, double v) {
    return {static_cast<float>(u), static_cast<float>(1.0 - v)};
}

} // namespace lambert
