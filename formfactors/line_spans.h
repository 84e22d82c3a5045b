#pragma once

#include "meshing/patch_mesh.h"
#include "scene/line_caster.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// The stretches of lines between one crossing and the next, as patches see them: each has a patch whose front it meets, a black
/// back or the outside at either end.
class LineSpans {
public:
    /// `mesh` and `caster` (of the same scene) must outlive it.
    LineSpans(const PatchMesh& mesh, const LineCaster& caster);

    std::uint32_t back() const { return static_cast<std::uint32_t>(mesh_.size()); }    //!< the end at a black back
    std::uint32_t out() const { return static_cast<std::uint32_t>(mesh_.size()) + 1; } //!< the end outside of the scene

    /// One per thread, keeps its memory.
    class Scratch {
        friend class LineSpans;
        LineCrossings crossings;
        /// The k-th crossings of the packet's lines, for the lookup.
        struct Hits {
            alignas(64) std::uint32_t polygon[16], patch[16];
            alignas(64) float u[16], v[16];
        };
        std::vector<Hits> hits;
    };

    /// Calls use(end, end) for every stretch of the packet's lines, in order along each.
    template <typename Use>
    void visit(const LinePacket& packet, Scratch& scratch, Use&& use) const {
        caster_.cross(packet, scratch.crossings);
        findPatches(scratch);
        for (int line = 0; line < LinePacket::kSize; ++line) {
            std::uint32_t left = out(); // what the line left last
            const std::span<const Crossing> crossings = scratch.crossings[line];
            for (std::size_t k = 0; k < crossings.size(); ++k) {
                const Crossing& crossing = crossings[k];
                std::uint32_t front = scratch.hits[k].patch[line];
                std::uint32_t behind = std::min(mesh_.lookup.backPatch(crossing.polygon, front), back());
                if (!occluder_.empty() && occluder_[crossing.polygon]) front = behind = back();
                use(left, crossing.front ? front : behind);
                left = crossing.front ? behind : front;
            }
            use(left, out());
        }
    }

private:
    void findPatches(Scratch& scratch) const;

    const PatchMesh& mesh_;
    const LineCaster& caster_;
    std::vector<bool> occluder_; ///< by polygon; empty: none
};

} // namespace lambert
