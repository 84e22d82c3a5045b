#include "scene/line_caster.h"

#include "core/vector_clones.h"
#include "scene/embree_scene.h"
#include "scene/surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <new>

namespace lambert {

namespace {

/// What the filter needs besides Embree's query, which begins with the context.
struct Query {
    RTCIntersectContext context;
    std::array<std::vector<Crossing>, LinePacket::kSize>* crossings;
    bool outOfMemory = false; ///< exceptions must not pass through Embree
};

/// Embree's filter: notes every hit and rejects it, so that the traversal goes on to the line's end.
template <bool WithHoles>
void noteCrossing(const RTCFilterFunctionNArguments* arguments) {
    auto& query = *reinterpret_cast<Query*>(arguments->context);
    const auto& polygons = *static_cast<const PolygonSet*>(arguments->geometryUserPtr);
    RTCHitN* hit = arguments->hit;
    RTCRayN* ray = arguments->ray;
    const unsigned n = arguments->N;
    for (unsigned lane = 0; lane < n; ++lane) {
        if (arguments->valid[lane] == 0) continue;
        arguments->valid[lane] = 0;
        if constexpr (WithHoles) {
            if (liesInHole(*arguments, lane)) continue;
        }
        const PolygonHit found =
            polygons.hit(RTCHitN_primID(hit, n, lane), RTCHitN_u(hit, n, lane), RTCHitN_v(hit, n, lane));
        const float facing = RTCHitN_Ng_x(hit, n, lane) * RTCRayN_dir_x(ray, n, lane) +
                             RTCHitN_Ng_y(hit, n, lane) * RTCRayN_dir_y(ray, n, lane) +
                             RTCHitN_Ng_z(hit, n, lane) * RTCRayN_dir_z(ray, n, lane);
        try {
            (*query.crossings)[RTCRayN_id(ray, n, lane)].push_back(
                {RTCRayN_tfar(ray, n, lane), found.u, found.v, found.polygon, facing < 0.0F});
        } catch (const std::bad_alloc&) {
            query.outOfMemory = true;
        }
    }
}

LAMBERT_VECTOR_CLONES
void load(const LinePacket& packet, float scale, RTCRay16& rays) {
    for (int lane = 0; lane < LinePacket::kSize; ++lane) {
        rays.org_x[lane] = scale * packet.originX[lane];
        rays.org_y[lane] = scale * packet.originY[lane];
        rays.org_z[lane] = scale * packet.originZ[lane];
        rays.dir_x[lane] = scale * packet.directionX[lane];
        rays.dir_y[lane] = scale * packet.directionY[lane];
        rays.dir_z[lane] = scale * packet.directionZ[lane];
    }
    beginRays(rays, 1.0F);
}

/// A line in double precision, for crossings that float cannot order.
struct ExactLine {
    glm::dvec3 origin, direction;

    ExactLine(const LinePacket& packet, int lane)
        : origin(packet.originX[lane], packet.originY[lane], packet.originZ[lane]),
          direction(packet.directionX[lane], packet.directionY[lane], packet.directionZ[lane]) {}
};

/// A crossing and the plane in which it lies.
struct ExactCrossing {
    Crossing crossing;
    glm::dvec3 a;      ///< the polygon's first corner
    glm::dvec3 normal; ///< unit length
    double distance;   ///< in lengths of the direction

    ExactCrossing(const Scene& scene, const ExactLine& line, const Crossing& c)
        : crossing(c), a(corner(scene, scene.polygons[c.polygon], 0)), distance(static_cast<double>(c.distance)) {
        const Polygon& polygon = scene.polygons[c.polygon];
        const int last = polygon.size() - 1;
        normal = glm::normalize(
            glm::cross(glm::dvec3(corner(scene, polygon, 1)) - a, glm::dvec3(corner(scene, polygon, last)) - a));
        const double slope = glm::dot(normal, line.direction);
        if (slope != 0.0) distance = glm::dot(normal, a - line.origin) / slope;
    }
};

/// Whether `a` is crossed before `b`; `tolerance` in lengths of the direction.
bool precedes(const ExactCrossing& a, const ExactCrossing& b, double tolerance) {
    constexpr double kParallel = 1.0 - 1e-8; // of the normals, to 1e-4
    const bool coincident =
        std::abs(glm::dot(a.normal, b.normal)) > kParallel && std::abs(a.distance - b.distance) <= tolerance;
    if ((coincident || a.distance == b.distance) && a.crossing.front != b.crossing.front) return a.crossing.front;
    return a.distance < b.distance;
}

/// Whether two crossings, the first of which is crossed first, only seem to be some: at the edge that their polygons have in
/// common, in an order that these do not allow. Such a line passes the edge outside, nearer than float can tell.
bool missBoth(const Scene& scene, const ExactCrossing& first, const ExactCrossing& second, double tolerance) {
    if (first.crossing.front == second.crossing.front || second.distance - first.distance > tolerance) return false;
    const Polygon& one = scene.polygons[first.crossing.polygon];
    const Polygon& two = scene.polygons[second.crossing.polygon];
    int common = 0;
    double beyond = 0.0; // how far `two` lies before the front of `one`
    for (int k = 0; k < two.size(); ++k) {
        const auto end = one.vertices.begin() + one.size();
        common += std::find(one.vertices.begin(), end, two.vertices[static_cast<std::size_t>(k)]) != end ? 1 : 0;
        beyond += glm::dot(first.normal, glm::dvec3(corner(scene, two, k)) - first.a);
    }
    // In a corner that is seen from within a line comes through a back and meets a front, over a ridge the other way.
    return common == 2 && (beyond > 0.0) == first.crossing.front;
}

/// Orders crossings [first, last), of which each is closer to the next than coordinates can tell. Returns the new end.
std::vector<Crossing>::iterator settle(const Scene& scene, const ExactLine& line, double tolerance,
                                       std::vector<Crossing>::iterator first, std::vector<Crossing>::iterator last) {
    std::vector<ExactCrossing> order;
    for (auto it = first; it != last; ++it) {
        const ExactCrossing next(scene, line, *it);
        // An edge within the polygon, between the two triangles of a quad.
        if (std::any_of(order.begin(), order.end(),
                        [&](const ExactCrossing& c) { return c.crossing.polygon == it->polygon; }))
            continue;
        // By insertion, because the order is not transitive.
        auto place = order.end();
        while (place != order.begin() && precedes(next, *(place - 1), tolerance)) --place;
        order.insert(place, next);
    }
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (k + 1 < order.size() && missBoth(scene, order[k], order[k + 1], tolerance)) {
            ++k;
            continue;
        }
        const bool again = k > 0 && order[k].crossing.front == order[k - 1].crossing.front &&
                           order[k].distance - order[k - 1].distance <= tolerance;
        if (!again) *first++ = order[k].crossing;
    }
    return first;
}

/// Settles all runs of crossings that are closer than `tolerance`, in lengths of the direction.
void settleAll(const Scene& scene, const LinePacket& packet, int lane, float tolerance,
               std::vector<Crossing>& crossings) {
    auto end = crossings.begin();
    for (auto first = crossings.begin(); first != crossings.end();) {
        auto last = first + 1;
        while (last != crossings.end() && last->distance - (last - 1)->distance <= tolerance) ++last;
        const auto settled = last - first == 1
                                 ? last
                                 : settle(scene, ExactLine(packet, lane), static_cast<double>(tolerance), first, last);
        end = end == first ? settled : std::move(first, settled, end);
        first = last;
    }
    crossings.erase(end, crossings.end());
}

/// Puts the crossings of a line into order and drops what counts twice; there are at least two. `tolerance` in lengths of the
/// direction.
void sortCrossings(const Scene& scene, const LinePacket& packet, int lane, float tolerance,
                   std::vector<Crossing>& crossings) {
    const auto nearer = [](const Crossing& a, const Crossing& b) {
        return a.distance != b.distance ? a.distance < b.distance : a.polygon < b.polygon;
    };
    if (crossings.size() > 2)
        std::sort(crossings.begin(), crossings.end(), nearer);
    else if (nearer(crossings[1], crossings[0]))
        std::swap(crossings[0], crossings[1]);
    bool anyClose = false;
    for (std::size_t k = 1; k < crossings.size(); ++k)
        anyClose |= crossings[k].distance - crossings[k - 1].distance <= tolerance;
    if (anyClose) settleAll(scene, packet, lane, tolerance, crossings);
}

} // namespace

struct LineCaster::Impl {
    explicit Impl(const Scene& source)
        : scene(source),
          bounds(boundsOf(source)),
          tolerance(coordinateTolerance(bounds)),
          embree(source, {.opaque = noteCrossing<false>, .withHoles = noteCrossing<true>}) {}

    const Scene& scene;
    Bounds bounds;
    float tolerance; ///< metres
    EmbreeScene embree;
};

LineCaster::LineCaster(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
LineCaster::~LineCaster() = default;
LineCaster::LineCaster(LineCaster&&) noexcept = default;

void LineCaster::cross(const LinePacket& packet, LineCrossings& crossings) const {
    for (std::vector<Crossing>& list : crossings.of_) list.clear();
    Query query{.context = {}, .crossings = &crossings.of_};
    // Not as coherent rays: Embree's kernel for these reports some hits several times.
    rtcInitIntersectContext(&query.context);
    alignas(64) RTCRay16 rays;
    load(packet, impl_->embree.scale(), rays);
    // A shadow ray: all of whose hits are rejected needs no order, and finds all of them.
    rtcOccluded16(packet.active, impl_->embree.handle(), &query.context, &rays);
    if (query.outOfMemory) throw std::bad_alloc();
    for (int lane = 0; lane < LinePacket::kSize; ++lane) {
        std::vector<Crossing>& list = crossings.of_[static_cast<std::size_t>(lane)];
        if (list.size() < 2) continue;
        const float length =
            glm::length(glm::vec3(packet.directionX[lane], packet.directionY[lane], packet.directionZ[lane]));
        sortCrossings(impl_->scene, packet, lane, impl_->tolerance / length, list);
    }
}

const Scene& LineCaster::scene() const { return impl_->scene; }
const Bounds& LineCaster::bounds() const { return impl_->bounds; }

} // namespace lambert
