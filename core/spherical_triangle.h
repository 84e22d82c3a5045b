#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace lambert {

/// Points of a triangle as they are seen from a point: uniform in solid angle, whatever the distance.
///
/// J. Arvo, "Stratified sampling of spherical triangles", SIGGRAPH 1995.
class SphericalTriangle {
public:
    /// From the origin. Nothing if the triangle is seen edge-on, or too small or large to be told from such.
    static std::optional<SphericalTriangle> seenFromOrigin(const std::array<glm::dvec3, 3>& corners) {
        SphericalTriangle triangle;
        for (std::size_t k = 0; k < 3; ++k) triangle.corner_[k] = glm::normalize(corners[k]);
        const auto& [a, b, c] = triangle.corner_;
        const glm::dvec3 ab = glm::cross(a, b), bc = glm::cross(b, c), ca = glm::cross(c, a);
        constexpr double kSmallest = 1e-20; // squared sines of the sides
        if (!(glm::dot(ab, ab) > kSmallest && glm::dot(bc, bc) > kSmallest && glm::dot(ca, ca) > kSmallest))
            return std::nullopt;
        triangle.alpha_ = angle(ab, -ca);
        triangle.solidAngle_ = triangle.alpha_ + angle(bc, -ab) + angle(ca, -bc) - std::numbers::pi;
        if (!(triangle.solidAngle_ > 1e-6 && triangle.alpha_ < std::numbers::pi - 1e-6)) return std::nullopt;
        return triangle;
    }

    double solidAngle() const { return solidAngle_; }

    /// The unit direction for a point of the unit square: (·, 0) is the second corner, (0, 1) the first, (1, 1) the third.
    glm::dvec3 direction(const glm::dvec2& u) const {
        const auto& [a, b, c] = corner_;
        const double turned = u.x * solidAngle_; // area of the part (a, b, c'), c' on the side ca
        const double sinPhi = std::sin(turned + std::numbers::pi - alpha_);
        const double cosPhi = std::cos(turned + std::numbers::pi - alpha_);
        const double cosAlpha = std::cos(alpha_), sinAlpha = std::sin(alpha_);
        const double k1 = cosPhi + cosAlpha;
        const double k2 = sinPhi - sinAlpha * glm::dot(a, b);
        const double above = k2 + (k2 * cosPhi - k1 * sinPhi) * cosAlpha;
        const double below = (k2 * sinPhi + k1 * cosPhi) * sinAlpha;
        const glm::dvec3 onSide = between(a, c, below != 0.0 ? std::clamp(above / below, -1.0, 1.0) : 1.0);
        return between(b, onSide, 1.0 - u.y * (1.0 - glm::dot(onSide, b)));
    }

private:
    static double angle(const glm::dvec3& a, const glm::dvec3& b) {
        return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    }
    /// The direction on the great circle from a to b whose angle with a has this cosine.
    static glm::dvec3 between(const glm::dvec3& a, const glm::dvec3& b, double cosine) {
        const glm::dvec3 across = b - glm::dot(a, b) * a;
        const double length = glm::length(across);
        if (!(length > 0.0)) return a;
        return cosine * a + std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) / length * across;
    }

    std::array<glm::dvec3, 3> corner_;
    double alpha_ = 0.0; ///< at the first corner
    double solidAngle_ = 0.0;
};

/// Maps the unit square to itself so that uniform points get the density that is bilinear between values > 0 at (0, 0), (1, 0),
/// (0, 1), (1, 1).
class BilinearWarp {
public:
    explicit BilinearWarp(const std::array<double, 4>& values) : w_(values) {}

    glm::dvec2 at(const glm::dvec2& u) const {
        const double y = linear(u.y, w_[0] + w_[1], w_[2] + w_[3]);
        return {linear(u.x, std::lerp(w_[0], w_[2], y), std::lerp(w_[1], w_[3], y)), y};
    }
    double density(const glm::dvec2& p) const {
        return 4.0 * std::lerp(std::lerp(w_[0], w_[1], p.x), std::lerp(w_[2], w_[3], p.x), p.y) /
               (w_[0] + w_[1] + w_[2] + w_[3]);
    }

private:
    static double linear(double u, double a, double b) {
        return std::min(u * (a + b) / (a + std::sqrt(std::lerp(a * a, b * b, u))), 1.0);
    }
    std::array<double, 4> w_;
};

} // namespace lambert
