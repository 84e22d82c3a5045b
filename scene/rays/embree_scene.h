#pragma once

#include "scene/rays/packet_width.h"
#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lambert {

/// A hit as the scene knows it.
struct PolygonHit {
    std::uint32_t polygon;
    float u, v; //!< see polygonPoint
};

/// Polygons as Embree has them: corners 0, 1, 3 (of a triangle 0, 1, 2) and, of a quad, 2, 3, 1. Its triangles are numbered through
/// all geometries.
struct TriangleTable {
    /// Of each triangle, twice the index into Scene::polygons, and 1 more for a quad's second half. Null if it would say k of the
    /// k-th throughout.
    const std::uint32_t* halves = nullptr;

    PolygonHit hit(std::uint32_t triangle, float u, float v) const {
        const std::uint32_t half = halves == nullptr ? triangle : halves[triangle];
        return (half & 1U) == 0 ? PolygonHit{half >> 1U, u, v} : PolygonHit{half >> 1U, 1.0F - u, 1.0F - v};
    }
};

/// User data of an Embree geometry.
struct GeometryData {
    const Scene* scene = nullptr;
    TriangleTable triangles;
    std::uint32_t first = 0; ///< number of the geometry's first triangle
};

/// The source polygons of a scene as Embree holds them: as triangles, which it meets at twice the rate of its own quads. Only for
/// the casters in this folder.
///
/// Embree divides by products of lengths in single precision and loses hits where these are small, from areas of 1e-20 m²
/// or, of short rays, 1e-12 m². So it gets all coordinates times a power of two that brings them to the order of 1, which
/// changes no digit.
class EmbreeScene {
public:
    /// What is called for every hit before it counts; null: nothing. For polygons with holes and for all others, so that
    /// these need no filter. Its geometryUserPtr is a const GeometryData.
    struct Filters {
        RTCFilterFunctionN opaque = nullptr;
        RTCFilterFunctionN withHoles = nullptr;
    };

    /// `scene` must outlive it. Every polygon must be finite and have an area. Throws SystemError.
    EmbreeScene(const Scene& scene, const Filters& filters);
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCScene handle() const { return embree_.get(); }
    /// For intersectPacket().
    PacketWidth width() const { return width_; }
    /// What the origins of rays must be multiplied by; in the same unit are the distances of rays of unit directions.
    float scale() const { return scale_; }
    TriangleTable triangles() const { return data_[kOpaque].triangles; }
    /// Number of the first triangle of one of the two geometries.
    std::uint32_t firstTriangle(unsigned geometry) const { return data_[geometry].first; }

private:
    /// Embree's number of a geometry.
    enum GeometryId : unsigned { kOpaque = 0, kWithHoles = 1 };

    void attach(GeometryId id, std::span<const std::uint32_t> halves, RTCFilterFunctionN filter);

    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };

    float scale_;
    std::vector<std::uint32_t> halves_; //!< of triangles(); empty if these need none
    std::array<GeometryData, 2> data_;  //!< by GeometryId
    std::unique_ptr<RTCDeviceTy, Release> device_;
    PacketWidth width_;
    std::unique_ptr<RTCSceneTy, Release> embree_;
};

/// Whether a hit (the `lane`-th of a filter's query) lies in a hole of its polygon.
bool liesInHole(const RTCFilterFunctionNArguments& query, unsigned lane);

/// Rounding of coordinates at the scene's scale (metres), generously: what is nearer cannot be told apart.
float coordinateTolerance(const Bounds& bounds);

/// Whether the scene has any polygons that only block light.
bool hasOccluders(const Scene& scene);

} // namespace lambert
