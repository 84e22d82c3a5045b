#pragma once

#include "scene/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lambert {

/// The compass of a scene: +Y is up, north is −Z and east is +X (in degrees clockwise from north, and above the horizon).
/// The result has unit length.
glm::dvec3 skyDirection(double azimuth, double elevation);

/// The weights of the cells of a latitude-longitude map, to draw directions by. Row 0 is at the zenith; columns go clockwise
/// seen from above, north in the middle. Within a cell directions are uniform.
class SkyMapDistribution {
public:
    /// `weight(column, row)` per sr, >= 0 and finite. Both counts >= 1.
    SkyMapDistribution(std::size_t columns, std::size_t rows,
                       const std::function<double(std::size_t column, std::size_t row)>& weight);

    struct Sample {
        glm::dvec3 direction; //!< unit length
        double density;       //!< per sr, > 0
    };
    /// The direction for a point of the unit square. Only if total() > 0.
    Sample sample(const glm::dvec2& u) const;
    double density(const glm::dvec3& direction) const; //!< per sr; `direction` has unit length

    /// The weights' integral over the sphere.
    double total() const { return rowSums_.back(); }

    struct Cell {
        std::size_t column, row;
    };
    static Cell cellOf(const glm::dvec3& direction, std::size_t columns, std::size_t rows);
    static double solidAngle(std::size_t row, std::size_t columns, std::size_t rows);

private:
    double weightOf(const Cell& cell) const; ///< as a share of the row

    std::size_t columns_, rows_;
    std::vector<double> rowSums_;     ///< #rows + 1, ascending
    std::vector<float> columnShares_; ///< #rows × #columns, ascending to 1 along each row
};

/// Light that comes from beyond the scene: its radiance by direction. Immutable.
class Environment {
public:
    /// The same radiance (per m² and sr, >= 0) from everywhere, from below as well.
    static Environment constant(const Rgb& radiance);
    /// A latitude-longitude picture, its rows and columns as in SkyMapDistribution; texels are constant patches of sky.
    static Environment image(std::shared_ptr<const Texture> image);
    /// Radiance by a function of the direction (of unit length), which varies slowly against a cell of the map that it is
    /// sampled by, one degree.
    static Environment function(std::function<Rgb(const glm::dvec3&)> radiance);

    /// From where one looks in `direction` (unit length), per m² and sr.
    Rgb radiance(const glm::dvec3& direction) const { return radiance_(direction); }
    /// Whether any light comes.
    bool isDark() const { return dark_; }
    /// By what is bright, in luminance; none for a constant or dark environment, which has no such place.
    const SkyMapDistribution* distribution() const { return distribution_.get(); }

private:
    std::function<Rgb(const glm::dvec3&)> radiance_;
    std::shared_ptr<const SkyMapDistribution> distribution_;
    bool dark_ = false;
};

/// Reads such a picture (EXR, HDR or another format with linear numbers; 8-bit ones are taken for sRGB) of at most 2^26 texels.
/// Throws InputError with the file's name if it is missing, broken or larger.
Environment readEnvironment(const std::filesystem::path& path);

} // namespace lambert
