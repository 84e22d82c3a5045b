#pragma once

#include "benchmarks/bare_embree.h"
#include "core/random.h"
#include "scene/rays/ray_caster.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace lambert {

/// Traces rays one by one and throws the hits away: returns how many there were.
inline std::size_t countHits(const BareEmbree& scene, const std::vector<Ray>& rays) {
    QueryContext context;
    beginQuery(context);
    std::size_t hits = 0;
    for (const Ray& ray : rays) {
        RTCRayHit query{};
        query.ray.org_x = ray.origin.x;
        query.ray.org_y = ray.origin.y;
        query.ray.org_z = ray.origin.z;
        query.ray.dir_x = ray.direction.x;
        query.ray.dir_y = ray.direction.y;
        query.ray.dir_z = ray.direction.z;
        query.ray.tfar = 1e30F;
        query.ray.mask = ~0U;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        intersect(scene.handle(), context, query);
        hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
    }
    return hits;
}

/// Puts the rays into an order without coherence.
inline std::vector<Ray> shuffled(const std::vector<Ray>& rays) {
    std::vector<std::uint32_t> order(rays.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [](std::uint32_t a, std::uint32_t b) {
        return philox({a, 0, 0, 0}, 1) < philox({b, 0, 0, 0}, 1);
    });
    std::vector<Ray> result;
    for (const std::uint32_t i : order) result.push_back(rays[i]);
    return result;
}

} // namespace lambert
