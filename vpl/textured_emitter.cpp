#include "vpl/textured_emitter.h"

#include "core/box.h"
#include "scene/polygon_points.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <vector>

namespace lambert {

namespace {

/// Cells of about a texel each, as far as they may be so many.
int cellsAlongAxis(const Scene& scene, const Polygon& polygon, const SurfaceSide& side, int mostCells) {
    const Texture& texture = *scene.textures[scene.materials[side.material].emissionTexture.texture];
    const auto& uv = scene.surfaces[side.surface].emissionUv;
    Box<glm::vec2> box;
    for (std::size_t k = 0; k < static_cast<std::size_t>(polygon.size()); ++k) box.add(uv[k]);
    const glm::vec2 texels = box.size() * glm::vec2(texture.width(), texture.height());
    const float most = std::min(std::max(texels.x, texels.y), static_cast<float>(mostCells));
    return std::min(static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(std::ceil(most), 1.0F)))), mostCells);
}

} // namespace

TexturedEmitter::TexturedEmitter(const Scene& scene, const Polygon& polygon, const SurfaceSide& side,
                                 const TexelAverage& texels, int mostCells)
    : isQuad_(polygon.isQuad()), cells_(cellsAlongAxis(scene, polygon, side, mostCells)) {
    const double first = PolygonPoints(scene, polygon).firstShare();
    shares_ = {first, 1.0 - first};
    const SurfaceCorners& corners = scene.surfaces[side.surface];
    const auto uv = [&](int x, int y) {
        return glm::dvec2(emissionUvAt(corners, isQuad_, static_cast<float>(x) / static_cast<float>(cells_),
                                       static_cast<float>(y) / static_cast<float>(cells_)));
    };
    const glm::dvec3 radiance(scene.materials[side.material].emittedRadiance);
    std::vector<double> importance;
    for (int y = 0; y < cells_; ++y) {
        for (int x = 0; x < cells_; ++x) {
            glm::dvec3 emitted(0.0);
            const auto add = [&](double share, std::initializer_list<glm::dvec2> footprint) {
                if (share > 0.0)
                    emitted += share * radiance * glm::max(glm::dvec3(texels.over(std::vector(footprint))), 0.0);
            };
            const std::array cell{uv(x, y), uv(x + 1, y), uv(x + 1, y + 1), uv(x, y + 1)};
            if (x + y < cells_ - 1) add(shareOfCell(0), {cell[0], cell[1], cell[2], cell[3]});
            if (x + y > cells_ - 1) add(shareOfCell(1), {cell[0], cell[1], cell[2], cell[3]});
            if (x + y == cells_ - 1) {
                add(0.5 * shareOfCell(0), {cell[0], cell[1], cell[3]});
                add(0.5 * shareOfCell(1), {cell[2], cell[3], cell[1]});
            }
            mean_ += emitted;
            importance.push_back(sumOf(emitted));
        }
    }
    const double largest = *std::max_element(importance.begin(), importance.end());
    if (!(largest > 0.0)) return;
    std::vector<float> relative; // which single precision has, whatever the unit of light
    for (const double value : importance) relative.push_back(static_cast<float>(value / largest));
    warp_.emplace(cells_, cells_, relative);
}

/// Of the area: a cell's that lies wholly in one of the triangles.
double TexturedEmitter::shareOfCell(int triangle) const {
    return 2.0 * shares_[static_cast<std::size_t>(triangle)] / (static_cast<double>(cells_) * cells_);
}

TexturedEmitter::Point TexturedEmitter::at(const glm::dvec2& u) const {
    glm::dvec2 place = warp_->warp(u);
    const int x = static_cast<int>(place.x);
    const int y = static_cast<int>(place.y);
    const double probability = warp_->probability(x, y);
    const bool diagonal = x + y == cells_ - 1;
    const bool above = place.x + place.y > cells_;
    // A triangle has but half of the cells on its long side.
    if (diagonal && !isQuad_) {
        if (above) place = glm::dvec2(2 * x + 1, 2 * y + 1) - place;
        return {glm::vec2(place / static_cast<double>(cells_)), 0.5 * shareOfCell(0) / probability};
    }
    return {glm::vec2(place / static_cast<double>(cells_)), shareOfCell(above ? 1 : 0) / probability};
}

} // namespace lambert
