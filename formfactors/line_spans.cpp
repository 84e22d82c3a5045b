#include "formfactors/line_spans.h"

#include <algorithm>
#include <array>

namespace lambert {

LineSpans::LineSpans(const PatchMesh& mesh, const LineCaster& caster) : mesh_(mesh), caster_(caster) {
    const Scene& scene = caster.scene();
    for (const Polygon& polygon : scene.polygons) occluder_.push_back(isOccluder(scene, polygon));
    if (std::find(occluder_.begin(), occluder_.end(), true) == occluder_.end()) occluder_.clear();
}

/// The k-th crossings of all lines together: neighbouring lines mostly cross the same polygon, for which the lookup is fastest.
void LineSpans::findPatches(Scratch& scratch) const {
    for (std::size_t k = 0;; ++k) {
        std::array<int, LinePacket::kSize> lanes{}; // that have a k-th crossing
        std::size_t count = 0;
        for (int lane = 0; lane < LinePacket::kSize; ++lane) {
            lanes[count] = lane;
            count += scratch.crossings[lane].size() > k ? 1 : 0;
        }
        if (count == 0) return;
        if (scratch.hits.size() == k) scratch.hits.emplace_back();
        Scratch::Hits& hits = scratch.hits[k];
        // Where few are missing, others stand for them, so that the polygons may still be all the same.
        const Crossing& other = scratch.crossings[lanes[0]][k];
        std::fill_n(hits.polygon, 16, count >= 8 ? other.polygon : kNone);
        std::fill_n(hits.u, 16, other.u);
        std::fill_n(hits.v, 16, other.v);
        for (std::size_t i = 0; i < count; ++i) {
            const Crossing& crossing = scratch.crossings[lanes[i]][k];
            hits.polygon[lanes[i]] = crossing.polygon;
            hits.u[lanes[i]] = crossing.u;
            hits.v[lanes[i]] = crossing.v;
        }
        mesh_.lookup.patchesAt(hits.polygon, hits.u, hits.v, hits.patch);
    }
}

} // namespace lambert
