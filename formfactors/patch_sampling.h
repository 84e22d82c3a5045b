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
        const glm::vec3 diagonal = corners_[2] - corners_[0];
        area012_ = static_cast<double>(glm::length(glm::cross(corners_[1] - corners_[0], diagonal)));
        area023_ = static_cast<double>(glm::length(glm::cross(diagonal, corners_[3] - corners_[0])));
        if (!(area012_ + area023_ > 0.0)) area012_ = 1.0; // a sliver: any of its points will do
    }

    glm::vec3 at(const glm::dvec2& u) const {
        const auto w = uniformQuad(u, area012_, area023_);
        glm::vec3 point(0.0F);
        for (std::size_t k = 0; k < 4; ++k) point += static_cast<float>(w[k]) * corners_[k];
        return point;
    }

private:
    std::array<glm::vec3, 4> corners_;
    double area012_, area023_;
};

} // namespace lambert
