#pragma once

#include "scene/scene.h"

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
    /// The k-th crossings of all lines, as in Crossing. Where a line has fewer, `polygon` is kNone.
    struct alignas(64) Row {
        float distance[LinePacket::kSize];
        float u[LinePacket::kSize], v[LinePacket::kSize];
        std::uint32_t polygon[LinePacket::kSize];
        std::uint32_t front[LinePacket::kSize]; //!< 1 for true
    };
    std::span<const Row> rows() const { return {rows_.data(), used_}; }
    /// How many a line has.
    std::uint32_t count(int lane) const { return count_[lane]; }
    /// Those of one line.
    std::vector<Crossing> of(int lane) const;

private:
    friend class LineCaster;
    std::vector<Row> rows_;
    std::size_t used_ = 0;
    alignas(64) std::uint32_t count_[LinePacket::kSize] = {};
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
