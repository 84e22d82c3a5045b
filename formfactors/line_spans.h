#pragma once

#include "meshing/patch_mesh.h"
#include "scene/rays/line_caster.h"

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
        // Row by row of the crossings:
        std::vector<std::uint32_t> polygon, front; ///< what is crossed, and the patch on its front
        std::vector<float> u, v;
    };

    /// Calls use(end, end) for every stretch of the packet's lines, in order along each.
    template <typename Use>
    void visit(const LinePacket& packet, Scratch& scratch, Use&& use) const {
        caster_.cross(packet, scratch.crossings);
        findPatches(scratch);
        const std::span<const LineCrossings::Row> rows = scratch.crossings.rows();
        for (int line = 0; line < LinePacket::kSize; ++line) {
            std::uint32_t left = out(); // what the line left last
            for (std::size_t k = 0; k < scratch.crossings.count(line); ++k) {
                const LineCrossings::Row& row = rows[k];
                std::uint32_t front = scratch.front[k * LinePacket::kSize + static_cast<std::size_t>(line)];
                std::uint32_t behind = back();
                if (mesh_.lookup.hasBacks())
                    behind = std::min(mesh_.lookup.backPatch(row.polygon[line], front), back());
                if (!occluder_.empty() && occluder_[row.polygon[line]]) front = behind = back();
                const bool fromFront = row.front[line] != 0;
                use(left, fromFront ? front : behind);
                left = fromFront ? behind : front;
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
