#pragma once

#include "baking/final_gather.h"
#include "baking/vertex_corners.h"

#include <vector>

namespace lambert {

/// A point that stands for a vertex, and how much of it.
struct VertexPlace {
    GatherPoint point;
    std::uint32_t patch; //!< on which it lies
    double weight;       //!< those of a vertex add up to 1
};

/// Where the light of a vertex is found. One in the middle of its smoothing side lies where it lies. One on its border lies also on
/// what stands there, or behind it: a point of the open patches about it stands for it, a thousandth of the way to their centres,
/// one for each of the planes that meet in the vertex. `covered` (#patches, F_back) tells the open patches. Empty if there are none.
class VertexPlaces {
public:
    /// All of it must be kept.
    VertexPlaces(const RayCaster& rays, const PatchMesh& mesh, const BakedMesh& baked, std::span<const float> covered);

    void of(std::size_t vertex, std::vector<VertexPlace>& places) const;
    /// The same on the most open patch alone, `share` of the way to its centre.
    VertexPlace inside(std::size_t vertex, float share) const;

private:
    bool isOpen(std::uint32_t corner) const;
    bool isClosedFan(std::size_t vertex) const;
    double weightOf(std::uint32_t corner) const;

    const RayCaster& rays_;
    const PatchMesh& mesh_;
    const BakedMesh& baked_;
    std::span<const float> covered_;
    VertexCorners around_;
};

} // namespace lambert
