#pragma once

#include "baking/baked_mesh.h"
#include "meshing/patch_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// Of each vertex of a baked mesh the corners of patches that meet there.
class VertexCorners {
public:
    VertexCorners(const PatchMesh& mesh, const BakedMesh& baked);

    /// 4 × patch + k each, ascending.
    std::span<const std::uint32_t> of(std::size_t vertex) const {
        const std::size_t begin = vertex == 0 ? 0 : ends_[vertex - 1];
        return std::span(corners_).subspan(begin, ends_[vertex] - begin);
    }

private:
    std::vector<std::uint32_t> ends_; ///< #vertices + 1, into corners_
    std::vector<std::uint32_t> corners_;
};

/// Of a patch at its corner k, radians.
double angleAt(const PatchMesh& mesh, std::size_t patch, int k);

} // namespace lambert
