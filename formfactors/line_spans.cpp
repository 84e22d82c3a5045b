#include "formfactors/line_spans.h"

#include <algorithm>

namespace lambert {

LineSpans::LineSpans(const PatchMesh& mesh, const LineCaster& caster) : mesh_(mesh), caster_(caster) {
    const Scene& scene = caster.scene();
    for (const Polygon& polygon : scene.polygons) occluder_.push_back(isOccluder(scene, polygon));
    if (std::find(occluder_.begin(), occluder_.end(), true) == occluder_.end()) occluder_.clear();
}

/// Rows that cross one polygon, for which the lookup is fastest, by themselves, and all others together.
void LineSpans::findPatches(Scratch& scratch) const {
    const std::span<const LineCrossings::Row> rows = scratch.crossings.rows();
    const std::size_t most = rows.size() * LinePacket::kSize;
    if (scratch.fronts.size() < rows.size()) {
        scratch.fronts.resize(rows.size());
        scratch.polygon.resize(most);
        scratch.patch.resize(most + 1); // read one past the end
        scratch.u.resize(most);
        scratch.v.resize(most);
    }
    std::size_t count = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const LineCrossings::Row& row = rows[k];
        if (PatchLookup::onOnePolygon(row.polygon)) {
            mesh_.lookup.patchesAt(row.polygon, row.u, row.v, scratch.fronts[k].of);
            continue;
        }
        for (int line = 0; line < LinePacket::kSize; ++line) {
            scratch.polygon[count] = row.polygon[line];
            scratch.u[count] = row.u[line];
            scratch.v[count] = row.v[line];
            count += row.polygon[line] != kNone ? 1 : 0;
        }
    }
    mesh_.lookup.patchesAt(std::span(scratch.polygon).first(count), scratch.u, scratch.v, scratch.patch);
    const std::uint32_t* next = scratch.patch.data();
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (PatchLookup::onOnePolygon(rows[k].polygon)) continue;
        for (int line = 0; line < LinePacket::kSize; ++line) {
            scratch.fronts[k].of[line] = *next;
            next += rows[k].polygon[line] != kNone ? 1 : 0;
        }
    }
}

} // namespace lambert
