#pragma once

#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lambert {

/// Where a line crosses a source polygon.
struct Crossing {
    float distance;        //!< in lengths of the line's direction, 0 to 1
    float u, v;            //!< chart of the polygon, see polygonPoint()
    std::uint32_t polygon; //!< into Scene::polygons
    bool front;            //!< the line meets the polygon on its front
};

/// 16 lines, from `origin` to `origin + direction`; laid out for vector code.
struct alignas(64) LinePacket {
    static constexpr int kSize = 16;
    float originX[kSize], originY[kSize], originZ[kSize];
    float directionX[kSize], directionY[kSize], directionZ[kSize];
    int active[kSize]; //!< -1 for a line to be traced, 0 for none
};

/// All that the lines of a packet cross, in order. One per thread, reused from packet to packet.
class LineCrossings {
public:
    std::span<const Crossing> operator[](int lane) const { return of_[static_cast<std::size_t>(lane)]; }

private:
    friend class LineCaster;
    std::array<std::vector<Crossing>, LinePacket::kSize> of_;
};

/// Finds all source polygons that lines cross, in one traversal each. Thread-safe. Holes are crossed by nothing (see
/// hasHoles); occluders are crossed like all others.
///
/// Closed surfaces whose polygons share their vertices are entered and left by turns. Crossings that lie closer together than
/// coordinates can tell (1e-6 of the largest one) are ordered by their planes in double precision. Where these coincide too,
/// as of two boxes that touch, fronts are met before backs are; of several polygons met there from the same side the first
/// one counts. What is left to rounding is a line within a few float steps of an edge: one in fifty of these, or some 1e-8
/// of all lines, enters a surface that it does not leave.
class LineCaster {
public:
    /// `scene` must outlive the caster. Every polygon must be finite and have an area.
    explicit LineCaster(const Scene& scene);
    ~LineCaster();
    LineCaster(LineCaster&&) noexcept;

    /// All crossings of every line, ascending; nothing for lines that are not active. The lines must be finite. Fastest if they are close
    /// to each other.
    void cross(const LinePacket& packet, LineCrossings& crossings) const;

    const Scene& scene() const;
    const Bounds& bounds() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace lambert
