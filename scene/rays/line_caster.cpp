#include "scene/rays/line_caster.h"

#include "core/vector_clones.h"
#include "scene/rays/embree_scene.h"
#include "scene/surface.h"

#include <boost/container/small_vector.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <new>

namespace lambert {

namespace {

using Row = LineCrossings::Row;
using Crossings = boost::container::small_vector<Crossing, 16>;
constexpr int kSize = LinePacket::kSize;
constexpr std::uint32_t kMissing = 0xFFFFFFFF; ///< in the place of a crossing that a line does not have

/// What the filter needs besides Embree's query, which begins with the context.
struct Query {
    QueryContext context;
    std::vector<Row>* rows;
    std::uint32_t* count;
    bool outOfMemory = false; ///< exceptions must not pass through Embree
};

/// Embree's filter: notes every hit and rejects it, so that the traversal goes on to the line's end. Notes for the polygon the number
/// of Embree's triangle, twice, and 1 more where the line meets its front.
template <bool WithHoles>
void noteCrossing(const RTCFilterFunctionNArguments* arguments) {
    auto& query = *reinterpret_cast<Query*>(arguments->context);
    const std::uint32_t first = static_cast<const GeometryData*>(arguments->geometryUserPtr)->first;
    RTCHitN* hit = arguments->hit;
    RTCRayN* ray = arguments->ray;
    const unsigned n = arguments->N;
    std::uint32_t lanes = 0; // first, because branches on each would be unpredictable
    for (unsigned lane = 0; lane < n; ++lane) {
        lanes |= (arguments->valid[lane] != 0 ? 1U : 0U) << lane;
        arguments->valid[lane] = 0;
    }
    for (; lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(lanes));
        if constexpr (WithHoles) {
            if (liesInHole(*arguments, lane)) continue;
        }
        const float facing = RTCHitN_Ng_x(hit, n, lane) * RTCRayN_dir_x(ray, n, lane) +
                             RTCHitN_Ng_y(hit, n, lane) * RTCRayN_dir_y(ray, n, lane) +
                             RTCHitN_Ng_z(hit, n, lane) * RTCRayN_dir_z(ray, n, lane);
        const unsigned line = RTCRayN_id(ray, n, lane);
        if (query.count[line] == query.rows->size()) {
            try {
                query.rows->emplace_back();
            } catch (const std::bad_alloc&) {
                query.outOfMemory = true;
                return;
            }
        }
        Row& row = (*query.rows)[query.count[line]++];
        row.distance[line] = RTCRayN_tfar(ray, n, lane);
        row.u[line] = RTCHitN_u(hit, n, lane);
        row.v[line] = RTCHitN_v(hit, n, lane);
        row.polygon[line] = (first + RTCHitN_primID(hit, n, lane)) * 2 + (facing < 0.0F ? 1U : 0U);
    }
}

/// Puts the crossings of every line into order, by distance and then triangle, those that it does not have last. A network of
/// comparisons, the same for all lines: "merge exchange" of K. E. Batcher, "Sorting networks and their applications", AFIPS 1968, as
/// algorithm M in D. E. Knuth, The Art of Computer Programming 3, 5.2.2.
LAMBERT_VECTOR_CLONES
void sortRows(Row* rows, std::size_t count, const std::uint32_t (&countOf)[kSize]) {
    for (std::size_t k = 0; k < count; ++k)
        for (int lane = 0; lane < kSize; ++lane) {
            const bool missing = countOf[lane] <= k;
            rows[k].distance[lane] = missing ? std::numeric_limits<float>::max() : rows[k].distance[lane];
            rows[k].polygon[lane] = missing ? kMissing : rows[k].polygon[lane];
        }
    const std::size_t top = std::bit_ceil(count) / 2;
    for (std::size_t p = top; p > 0; p /= 2) {
        std::size_t r = 0;
        std::size_t d = p;
        for (std::size_t q = top;; q /= 2) {
            for (std::size_t i = 0; i + d < count; ++i) {
                if ((i & p) != r) continue;
                Row& a = rows[i];
                Row& b = rows[i + d];
                for (int lane = 0; lane < kSize; ++lane) {
                    const bool swap = (b.distance[lane] < a.distance[lane]) |
                                      ((b.distance[lane] == a.distance[lane]) & (b.polygon[lane] < a.polygon[lane]));
                    const float distance = swap ? b.distance[lane] : a.distance[lane];
                    b.distance[lane] = swap ? a.distance[lane] : b.distance[lane];
                    a.distance[lane] = distance;
                    const float u = swap ? b.u[lane] : a.u[lane];
                    b.u[lane] = swap ? a.u[lane] : b.u[lane];
                    a.u[lane] = u;
                    const float v = swap ? b.v[lane] : a.v[lane];
                    b.v[lane] = swap ? a.v[lane] : b.v[lane];
                    a.v[lane] = v;
                    const std::uint32_t polygon = swap ? b.polygon[lane] : a.polygon[lane];
                    b.polygon[lane] = swap ? a.polygon[lane] : b.polygon[lane];
                    a.polygon[lane] = polygon;
                }
            }
            if (q == p) break;
            d = q - p;
            r = p;
        }
    }
}

/// Turns what the filter noted into polygons and their charts. `halves` as in TriangleTable.
LAMBERT_VECTOR_CLONES
void findPolygons(Row* rows, std::size_t count, const std::uint32_t* halves) {
    for (std::size_t k = 0; k < count; ++k) {
        Row& row = rows[k];
        std::uint32_t half[kSize];
        for (int lane = 0; lane < kSize; ++lane) half[lane] = row.polygon[lane] == kMissing ? 0 : row.polygon[lane] / 2;
        if (halves != nullptr)
            for (int lane = 0; lane < kSize; ++lane) half[lane] = halves[half[lane]];
        for (int lane = 0; lane < kSize; ++lane) {
            const bool missing = row.polygon[lane] == kMissing;
            const bool second = (half[lane] & 1U) != 0;
            const float u = second ? 1.0F - row.u[lane] : row.u[lane];
            const float v = second ? 1.0F - row.v[lane] : row.v[lane];
            row.u[lane] = missing ? 0.0F : u;
            row.v[lane] = missing ? 0.0F : v;
            row.front[lane] = row.polygon[lane] & 1U;
            row.polygon[lane] = missing ? kNone : half[lane] / 2;
        }
    }
}

/// Whether each line has two crossings in sequence that are closer than `tolerance` (metres). Returns whether one has.
LAMBERT_VECTOR_CLONES
bool findClose(const LinePacket& packet, const Row* rows, std::size_t count, float tolerance,
               std::uint32_t (&close)[kSize]) {
    float nearest[kSize];
    std::fill_n(nearest, kSize, std::numeric_limits<float>::max());
    for (std::size_t k = 1; k < count; ++k)
        for (int lane = 0; lane < kSize; ++lane) {
            const float distance = rows[k].polygon[lane] == kNone ? std::numeric_limits<float>::max()
                                                                  : rows[k].distance[lane] - rows[k - 1].distance[lane];
            nearest[lane] = distance < nearest[lane] ? distance : nearest[lane];
        }
    std::uint32_t any = 0;
    for (int lane = 0; lane < kSize; ++lane) {
        const float x = packet.directionX[lane];
        const float y = packet.directionY[lane];
        const float z = packet.directionZ[lane];
        close[lane] = nearest[lane] <= tolerance / std::sqrt(x * x + y * y + z * z) ? 1 : 0;
        any |= close[lane];
    }
    return any != 0;
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
    beginRays(packet.active, 1.0F, rays);
    leaveOutUntraceable(rays);
}

Crossing crossingIn(const Row& row, int lane) {
    return {row.distance[lane], row.u[lane], row.v[lane], row.polygon[lane], row.front[lane] != 0};
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
Crossings::iterator settle(const Scene& scene, const ExactLine& line, double tolerance, Crossings::iterator first,
                           Crossings::iterator last) {
    boost::container::small_vector<ExactCrossing, 4> order;
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
void settleAll(const Scene& scene, const LinePacket& packet, int lane, float tolerance, Crossings& crossings) {
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

    /// Settles the crossings of a line that lie too close together.
    void settleLine(const LinePacket& packet, int lane, LineCrossings& crossings) const {
        const float length =
            glm::length(glm::vec3(packet.directionX[lane], packet.directionY[lane], packet.directionZ[lane]));
        Crossings list;
        for (const Row& row : crossings.rows().first(crossings.count(lane))) list.push_back(crossingIn(row, lane));
        settleAll(scene, packet, lane, tolerance / length, list);
        crossings.count_[lane] = static_cast<std::uint32_t>(list.size());
        for (std::size_t k = 0; k < crossings.used_; ++k) {
            Row& row = crossings.rows_[k];
            row.polygon[lane] = k < list.size() ? list[k].polygon : kNone;
            if (k >= list.size()) continue;
            row.distance[lane] = list[k].distance;
            row.u[lane] = list[k].u;
            row.v[lane] = list[k].v;
            row.front[lane] = list[k].front ? 1 : 0;
        }
    }
};

LineCaster::LineCaster(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
LineCaster::~LineCaster() = default;
LineCaster::LineCaster(LineCaster&&) noexcept = default;

std::vector<Crossing> LineCrossings::of(int lane) const {
    std::vector<Crossing> result;
    for (const Row& row : rows().first(count(lane))) result.push_back(crossingIn(row, lane));
    return result;
}

void LineCaster::cross(const LinePacket& packet, LineCrossings& crossings) const {
    std::fill_n(crossings.count_, kSize, 0);
    Query query{.context = {}, .rows = &crossings.rows_, .count = crossings.count_};
    beginQuery(query.context);
    alignas(64) RTCRay16 rays;
    load(packet, impl_->embree.scale(), rays);
    // A shadow ray: all of whose hits are rejected needs no order, and finds all of them.
    // Not as coherent rays: Embree's kernel for these reports some hits several times.
    occludedPacket(impl_->embree.width(), packet.active, impl_->embree.handle(), query.context, Likeness::None, rays);
    if (query.outOfMemory) throw std::bad_alloc();
    crossings.used_ = *std::max_element(crossings.count_, crossings.count_ + kSize);
    Row* rows = crossings.rows_.data();
    sortRows(rows, crossings.used_, crossings.count_);
    findPolygons(rows, crossings.used_, impl_->embree.triangles().halves);
    std::uint32_t close[kSize];
    if (!findClose(packet, rows, crossings.used_, impl_->tolerance, close)) return;
    for (int lane = 0; lane < kSize; ++lane)
        if (close[lane] != 0) impl_->settleLine(packet, lane, crossings);
}

const Scene& LineCaster::scene() const { return impl_->scene; }
const Bounds& LineCaster::bounds() const { return impl_->bounds; }

} // namespace lambert
