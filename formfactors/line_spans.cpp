#include "formfactors/line_spans.h"

#include <algorithm>

namespace lambert {

LineSpans::LineSpans(const PatchMesh& mesh, const LineCaster& caster) : mesh_(mesh), caster_(caster) {
    const Scene& scene = caster.scene();
    for (const Polygon& polygon : scene.polygons) occluder_.push_back(isOccluder(scene, polygon));
    if (std::find(occluder_.begin(), occluder_.end(), true) == occluder_.end()) occluder_.clear();
}

void LineSpans::findPatches(Scratch& scratch) const {
    const std::span<const LineCrossings::Row> rows = scratch.crossings.rows();
    const std::size_t count = rows.size() * LinePacket::kSize;
    if (scratch.front.size() < count) {
        scratch.front.resize(count);
        scratch.polygon.resize(count);
        scratch.u.resize(count);
        scratch.v.resize(count);
    }
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const auto at = static_cast<std::ptrdiff_t>(k * LinePacket::kSize);
        std::ranges::copy(rows[k].polygon, scratch.polygon.begin() + at);
        std::ranges::copy(rows[k].u, scratch.u.begin() + at);
        std::ranges::copy(rows[k].v, scratch.v.begin() + at);
    }
    mesh_.lookup.patchesAt(std::span(scratch.polygon).first(count), scratch.u, scratch.v, scratch.front);
}

} // namespace lambert
