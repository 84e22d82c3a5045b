#pragma once

#include "scene/example_scenes.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>

namespace lambert {

/// Boxes whose walls are grids of quads with common vertices, of one grey material.
class GridScene {
public:
    /// Where a point of the boxes is put.
    using Map = std::function<glm::dvec3(const glm::dvec3&)>;

    GridScene();
    /// Adds six walls of n² quads each, their fronts inside or outside.
    GridScene& box(const glm::dvec3& low, const glm::dvec3& high, int n, bool inside, const Map& map);
    const Scene& scene() const { return scene_; }

private:
    void grid(const glm::dvec3& corner, const glm::dvec3& along, const glm::dvec3& across, int n, const Map& map);

    Scene scene_;
    std::map<std::array<long, 3>, std::uint32_t> vertices_; ///< by place before the map, in µm
};

/// Maps for GridScene. The first three are affine; a turned box has no edge along an axis.
inline glm::dvec3 same(const glm::dvec3& p) { return p; }

inline glm::dvec3 sheared(const glm::dvec3& p) { return {p.x + 0.3 * p.z + 0.1 * p.y, p.y + 0.2 * p.z, p.z}; }

inline glm::dvec3 turned(const glm::dvec3& p) {
    const double c = std::cos(0.7), s = std::sin(0.7);
    const glm::dvec3 q(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
    return {q.x, c * q.y - s * q.z, s * q.y + c * q.z};
}

/// A strip of the wall z = 0 of the unit cube is pushed in, so that the room is not convex.
inline glm::dvec3 dented(const glm::dvec3& p) {
    return std::abs(p.x - 0.5) < 0.26 ? glm::dvec3(p.x, p.y, 0.25 + 0.75 * p.z) : p;
}

inline GridScene::GridScene() {
    scene_.materials = {greyMaterial("grey", 0.5F, 1.0F)};
    scene_.nodes = {"grids"};
}

inline GridScene& GridScene::box(const glm::dvec3& low, const glm::dvec3& high, int n, bool inside, const Map& map) {
    const glm::dvec3 d = high - low, x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
    const std::array corners{low, low + x, low, low + y, low, low + z};
    const std::array along{y, z, z, x, x, y}, across{z, y, x, z, y, x};
    for (std::size_t k = 0; k < 6; ++k)
        inside ? grid(corners[k], along[k], across[k], n, map) : grid(corners[k], across[k], along[k], n, map);
    return *this;
}

inline void GridScene::grid(const glm::dvec3& corner, const glm::dvec3& along, const glm::dvec3& across, int n,
                            const Map& map) {
    const auto vertex = [&](int a, int b) {
        const glm::dvec3 p = corner + along * (static_cast<double>(a) / n) + across * (static_cast<double>(b) / n);
        const std::array key{std::lround(p.x * 1e6), std::lround(p.y * 1e6), std::lround(p.z * 1e6)};
        const auto [found, isNew] = vertices_.try_emplace(key, static_cast<std::uint32_t>(scene_.positions.size()));
        if (isNew) scene_.positions.emplace_back(map(p));
        return found->second;
    };
    for (int a = 0; a < n; ++a) {
        for (int b = 0; b < n; ++b) {
            Polygon polygon;
            polygon.vertices = {vertex(a, b), vertex(a + 1, b), vertex(a + 1, b + 1), vertex(a, b + 1)};
            scene_.polygons.push_back(polygon);
        }
    }
}

} // namespace lambert
