#pragma once

#include "scene/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace lambert {

/// Averages what an image says over polygons in texture space, where its texels are constant squares and it continues
/// beyond [0, 1] as its wraps say.
///
/// By Green's theorem the integral over a polygon is one along its border: ∬ f dx dy = ∮ F dy with F = ∫ f dx. F is linear
/// within a texel, so that the sum over the texels that the border crosses is exact, whatever the number of texels inside.
class TexelAverage {
public:
    /// Up to four values of a texel; 0 <= x < width, 0 <= y < height.
    using Field = std::function<glm::dvec4(int x, int y)>;

    /// Calls `field` for every texel now, and for some later, from several threads.
    TexelAverage(int width, int height, TextureWrap wrapU, TextureWrap wrapV, Field field);

    /// The mean over a convex polygon (at least one corner, finite, in either order); over a polygon without area that along
    /// its line or at its point.
    ///
    /// Exact but for rounding, up to a border that crosses 65536 texels. Of a longer one, the image is averaged to 64 × 64
    /// cells first, and if it crosses as many of these, to one: the mean is then off by at most the contrast of the image
    /// times a quarter of the share of cells on the border, 1/256 for a square footprint of 4 × 4 images.
    glm::dvec4 over(std::span<const glm::dvec2> uv) const;

private:
    /// Texels along one axis, without end.
    struct Axis {
        int size;
        TextureWrap wrap;
        /// The first and the last texel reach to infinity: no lines beyond size − 1.
        bool bounded() const { return wrap == TextureWrap::Clamp || size == 1; }
        std::int64_t cellAt(double place) const;
        int texel(std::int64_t cell) const;
        double period() const { return wrap == TextureWrap::Mirror ? 2.0 : 1.0; }
        double lines(double from, double to) const; //!< between texels, about
    };

    std::vector<glm::dvec2> inTexels(std::span<const glm::dvec2> uv) const;
    double crossings(std::span<const glm::dvec2> border) const;
    glm::dvec4 integral(std::span<const glm::dvec2> border) const;
    glm::dvec4 alongBorder(std::span<const glm::dvec2> border) const;
    glm::dvec4 value(std::int64_t column, int row) const { return field_(columns_.texel(column), row); }
    glm::dvec4 prefix(int row, int count) const;
    glm::dvec4 sumBefore(int row, std::int64_t column) const;

    template <typename Visit>
    static void forCells(const Axis& axis, double from, double to, Visit&& visit);
    template <typename Visit>
    static void forRows(const Axis& axis, const glm::dvec2& from, const glm::dvec2& to, Visit&& visit);

    Axis columns_, rows_;
    Field field_;
    std::size_t blocks_;             //!< per row
    std::vector<glm::dvec4> before_; //!< #rows × blocks_: the sum of all texels of the row before the block
    std::unique_ptr<const TexelAverage> coarser_;
};

} // namespace lambert
