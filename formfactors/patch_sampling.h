#pragma once

#include "core/warps.h"
#include "meshing/patch_mesh.h"

namespace lambert {

/// Maps the unit square to the points of a patch, keeping areas; for uniform `u` the points are uniform on it.
class PatchPoints {
public:
    PatchPoints(const PatchMesh& mesh, std::size_t patch)
        : corners_{mesh.position(patch, 0), mesh.position(patch, 1), mesh.position(patch, 2),
                   mesh.isQuad(patch) ? mesh.position(patch, 3) : mesh.position(patch, 2)} {
        // In double: the square of a small area does not exist in single precision.
        const glm::dvec3 origin(corners_[0]), diagonal = glm::dvec3(corners_[2]) - origin;
        area012_ = glm::length(glm::cross(glm::dvec3(corners_[1]) - origin, diagonal));
        area023_ = glm::length(glm::cross(diagonal, glm::dvec3(corners_[3]) - origin));
        if (!(area012_ + area023_ > 0.0)) area012_ = 1.0; // a sliver: any of its points will do
    }

    glm::vec3 at(const glm::dvec2& u) const {
        const auto w = uniformQuad(u, area012_, area023_);
        glm::vec3 point(0.0F);
        for (std::size_t k = 0; k < 4; ++k) point += static_cast<float>(w[k]) * corners_[k];
        return point;
    }

    /// The corners, for who maps in single precision; a triangle repeats its last one.
    const std::array<glm::vec3, 4>& corners() const { return corners_; }
    /// Area of the first of the triangles (0, 1, 2) and (0, 2, 3), as a share of both.
    float firstShare() const { return static_cast<float>(area012_ / (area012_ + area023_)); }

    /// Points, plus `offset`, for `count` points of the unit square, the second coordinates `stride` after the first ones. The same in
    /// single precision, and vectorised where the file is compiled with -fno-math-errno.
    void fill(const float* u, std::size_t stride, std::size_t count, const glm::vec3& offset, float* x, float* y,
              float* z) const {
        const glm::vec3 a = corners_[0] + offset;
        const glm::vec3 b = corners_[1] - corners_[0];
        const glm::vec3 c = corners_[2] - corners_[0];
        const glm::vec3 d = corners_[3] - corners_[0];
        const float share = firstShare();
        const float inverse = share > 0.0F ? 1.0F / share : 0.0F;
        const float inverseRest = share < 1.0F ? 1.0F / (1.0F - share) : 0.0F;
#pragma GCC ivdep
        for (std::size_t i = 0; i < count; ++i) {
            const bool first = u[i] < share; // as uniformQuad
            const float rescaled = first ? u[i] * inverse : (u[i] - share) * inverseRest;
            const float root = std::sqrt(rescaled < 1.0F ? rescaled : 1.0F);
            const float v = root * (1.0F - u[i + stride]);
            const float w = root * u[i + stride];
            x[i] = a.x + v * (first ? b.x : c.x) + w * (first ? c.x : d.x);
            y[i] = a.y + v * (first ? b.y : c.y) + w * (first ? c.y : d.y);
            z[i] = a.z + v * (first ? b.z : c.z) + w * (first ? c.z : d.z);
        }
    }

private:
    std::array<glm::vec3, 4> corners_;
    double area012_, area023_;
};

} // namespace lambert
