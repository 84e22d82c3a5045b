#include "meshing/patch_optics.h"

#include "core/parallel.h"
#include "meshing/patch_pieces.h"
#include "scene/surface.h"
#include "scene/texel_average.h"

#include <glm/common.hpp>

#include <algorithm>
#include <map>
#include <numbers>
#include <tuple>

namespace lambert {

namespace {

constexpr double kLeastOpacity = 1e-6;
constexpr double kRounding = 1e-9; ///< of a share of a patch
constexpr std::uint64_t kMostTexels = std::uint64_t{1} << 28;

/// An image as it is averaged: colours where the mask is opaque, and the mask.
struct Layer {
    TextureUse colour;
    TextureUse mask;
    float cutoff = 0.0F;

    bool operator<(const Layer& other) const { return key() < other.key(); }

private:
    std::tuple<std::uint32_t, TextureWrap, TextureWrap, std::uint32_t, TextureWrap, TextureWrap, float> key() const {
        return {colour.texture, colour.wrapU, colour.wrapV, mask.texture, mask.wrapU, mask.wrapV, cutoff};
    }
};

/// Whether one grid of texels does for both textures of a layer.
bool shareGrid(const Scene& scene, const Layer& layer) {
    if (!layer.colour || !layer.mask) return true;
    const Texture& a = *scene.textures[layer.colour.texture];
    const Texture& b = *scene.textures[layer.mask.texture];
    const auto width = static_cast<std::uint64_t>(std::max(a.width(), b.width()));
    const auto height = static_cast<std::uint64_t>(std::max(a.height(), b.height()));
    return layer.colour.wrapU == layer.mask.wrapU && layer.colour.wrapV == layer.mask.wrapV &&
           width * height <= kMostTexels;
}

/// Averages (rgb where opaque, opaque) over the texels of a layer whose textures share a grid: that of the larger one, at the
/// centres of whose texels the other is looked up.
std::unique_ptr<const TexelAverage> averageOf(const Scene& scene, const Layer& layer) {
    const Texture* colour = layer.colour ? scene.textures[layer.colour.texture].get() : nullptr;
    const Texture* mask = layer.mask ? scene.textures[layer.mask.texture].get() : nullptr;
    const int width = std::max(colour != nullptr ? colour->width() : 1, mask != nullptr ? mask->width() : 1);
    const int height = std::max(colour != nullptr ? colour->height() : 1, mask != nullptr ? mask->height() : 1);
    const auto scaled = [](int place, int from, int to) {
        return from == to ? place : static_cast<int>((2 * std::int64_t{place} + 1) * to / (2 * std::int64_t{from}));
    };
    const auto value = [=, cutoff = layer.cutoff](int x, int y) {
        const auto opacityAt = [&](const Texture& t) {
            return t.opacity(scaled(x, width, t.width()), scaled(y, height, t.height()));
        };
        if (mask != nullptr && opacityAt(*mask) < cutoff) return glm::dvec4(0.0);
        if (colour == nullptr) return glm::dvec4(1.0);
        const glm::vec4 texel = colour->texel(scaled(x, width, colour->width()), scaled(y, height, colour->height()));
        return glm::dvec4(texel.x, texel.y, texel.z, 1.0);
    };
    const TextureUse& wraps = layer.colour ? layer.colour : layer.mask;
    return std::make_unique<TexelAverage>(width, height, wraps.wrapU, wraps.wrapV, value);
}

/// The averages of all layers that a mesh shows.
class LayerAverages {
public:
    explicit LayerAverages(const Scene& scene) : scene_(scene) {}

    void require(const Layer& layer) {
        if (shareGrid(scene_, layer)) {
            averages_.try_emplace(layer);
        } else {
            averages_.try_emplace(Layer{layer.colour, {}, 0.0F});
            averages_.try_emplace(Layer{{}, layer.mask, layer.cutoff});
        }
    }

    void build() {
        std::vector<std::pair<const Layer, std::unique_ptr<const TexelAverage>>*> entries;
        for (auto& entry : averages_) entries.push_back(&entry);
        parallelFor(entries.size(), 1, [&](std::size_t begin, std::size_t end, int) {
            for (std::size_t k = begin; k < end; ++k) entries[k]->second = averageOf(scene_, entries[k]->first);
        });
    }

    glm::dvec4 over(const Layer& layer, std::span<const glm::dvec2> uv) const {
        if (const auto joint = averages_.find(layer); joint != averages_.end()) return joint->second->over(uv);
        const glm::dvec4 colour = averages_.at({layer.colour, {}, 0.0F})->over(uv);
        return colour * averages_.at({{}, layer.mask, layer.cutoff})->over(uv).w;
    }

private:
    const Scene& scene_;
    std::map<Layer, std::unique_ptr<const TexelAverage>> averages_;
};

/// One side of a polygon that has a surface.
struct Side {
    const Material& material;
    const SurfaceCorners& corners;
    Layer reflectance, emission;

    Side(const Scene& scene, const Polygon& polygon, std::uint32_t materialIndex, std::uint32_t surface)
        : material(scene.materials[materialIndex]), corners(scene.surfaces[surface]) {
        reflectance.colour = material.reflectanceTexture;
        emission.colour = material.emissionTexture;
        if (!material.hasHoles()) return;
        reflectance.mask = material.opacityTexture;
        reflectance.cutoff = material.opacityCutoff;
        const auto count = static_cast<std::ptrdiff_t>(polygon.size());
        if (emission.colour && !std::equal(corners.uv.begin(), corners.uv.begin() + count, corners.emissionUv.begin()))
            return;
        emission.mask = reflectance.mask;
        emission.cutoff = reflectance.cutoff;
    }
};

std::vector<glm::dvec2> footprint(const PatchPiece& piece, const std::array<glm::vec2, 4>& uv) {
    std::vector<glm::dvec2> result;
    for (const glm::dvec3& w : piece.border)
        result.push_back(w.x * glm::dvec2(uv[piece.corners[0]]) + w.y * glm::dvec2(uv[piece.corners[1]]) +
                         w.z * glm::dvec2(uv[piece.corners[2]]));
    return result;
}

glm::dvec3 meanTint(const PatchPiece& piece, const std::array<Rgb, 4>& tint) {
    const glm::dvec3& w = piece.centroid;
    return w.x * glm::dvec3(tint[piece.corners[0]]) + w.y * glm::dvec3(tint[piece.corners[1]]) +
           w.z * glm::dvec3(tint[piece.corners[2]]);
}

double roundedOpacity(double opacity) {
    if (opacity < kRounding) return 0.0;
    return opacity > 1.0 - kRounding ? 1.0 : opacity;
}

/// What is seen of one side of a patch. All are integrals over the patch, divided by its whole area.
struct SideSums {
    glm::dvec3 reflected{0.0}; //!< texture times tint, where there is no hole
    glm::dvec3 emitted{0.0};   //!< texture, where there is no hole
    double opaque = 0.0;
    double opaqueEmission = 0.0; //!< `opaque` as the emission counts it

    SideSums(const std::vector<PatchPiece>& pieces, const Side& side, const LayerAverages& layers) {
        for (const PatchPiece& piece : pieces) {
            const glm::dvec4 seen = layers.over(side.reflectance, footprint(piece, side.corners.uv));
            reflected += piece.share * meanTint(piece, side.corners.tint) * glm::dvec3(seen);
            opaque += piece.share * seen.w;
            const glm::dvec4 lit = layers.over(
                side.emission, footprint(piece, side.emission.colour ? side.corners.emissionUv : side.corners.uv));
            emitted += piece.share * glm::dvec3(lit);
            opaqueEmission += piece.share * lit.w;
        }
        opaque = roundedOpacity(opaque);
    }
};

bool anyHoles(const Scene& scene) {
    return std::any_of(scene.polygons.begin(), scene.polygons.end(),
                       [&](const Polygon& polygon) { return hasHoles(scene, polygon); });
}

/// The averages of all layers for which `wanted(side)` names one.
template <typename Wanted>
void buildLayers(const Scene& scene, LayerAverages& layers, const Wanted& wanted) {
    for (const Polygon& polygon : scene.polygons) {
        const auto require = [&](std::uint32_t material, std::uint32_t surface) {
            if (material == kNone || surface == kNone) return;
            wanted(polygon, Side(scene, polygon, material, surface));
        };
        require(polygon.material, polygon.surface);
        require(polygon.backMaterial, polygon.backSurface);
    }
    layers.build();
}

void averagePatch(const Scene& scene, const LayerAverages& layers, const PatchMesh& mesh, std::size_t patch,
                  PatchOptics& optics) {
    const Polygon& polygon = scene.polygons[mesh.polygon[patch]];
    const std::uint32_t surface = mesh.isBack(patch) ? polygon.backSurface : polygon.surface;
    if (surface == kNone) return;
    const Side side(scene, polygon, mesh.material[patch], surface);
    const SideSums sums(patchPieces(scene, mesh, patch), side, layers);
    // Where only the back has holes, the sheet is whole: what is in them is black.
    const bool holes = hasHoles(scene, polygon);
    const auto mean = [&](const glm::dvec3& sum, double opaque) {
        if (sums.opaque == 0.0) return glm::dvec3(0.0);
        return holes ? sum / std::max(opaque, kLeastOpacity) : sum;
    };
    const glm::dvec3 reflectance = glm::dvec3(side.material.reflectance) * mean(sums.reflected, sums.opaque);
    optics.reflectance[patch] = glm::clamp(Rgb(reflectance), 0.0F, kMaxReflectance);
    const glm::dvec3 emitted = mean(sums.emitted, sums.opaqueEmission);
    optics.emittedRadiosity[patch] =
        std::numbers::pi_v<float> * side.material.emittedRadiance * Rgb(glm::max(emitted, 0.0));
}

} // namespace

PatchOptics patchOptics(const Scene& scene, const PatchMesh& mesh) {
    PatchOptics optics;
    optics.reflectance.reserve(mesh.size());
    optics.emittedRadiosity.reserve(mesh.size());
    for (const std::uint32_t material : mesh.material) {
        optics.reflectance.push_back(scene.materials[material].reflectance);
        optics.emittedRadiosity.push_back(std::numbers::pi_v<float> * scene.materials[material].emittedRadiance);
    }
    LayerAverages layers(scene);
    buildLayers(scene, layers, [&](const Polygon&, const Side& side) {
        layers.require(side.reflectance);
        layers.require(side.emission);
    });
    parallelFor(mesh.size(), 256, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t patch = begin; patch < end; ++patch) averagePatch(scene, layers, mesh, patch, optics);
    });
    return optics;
}

void measureHoles(const Scene& scene, PatchMesh& mesh) {
    if (!anyHoles(scene)) return;
    LayerAverages layers(scene);
    buildLayers(scene, layers, [&](const Polygon& polygon, const Side& side) {
        if (hasHoles(scene, polygon)) layers.require(side.reflectance);
    });
    mesh.opacity.assign(mesh.size(), 1.0F);
    parallelFor(mesh.size(), 256, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t patch = begin; patch < end; ++patch) {
            const Polygon& polygon = scene.polygons[mesh.polygon[patch]];
            if (!hasHoles(scene, polygon)) continue;
            const Side front(scene, polygon, polygon.material, polygon.surface);
            double opacity = 0.0;
            for (const PatchPiece& piece : patchPieces(scene, mesh, patch))
                opacity += piece.share * layers.over(front.reflectance, footprint(piece, front.corners.uv)).w;
            opacity = roundedOpacity(opacity);
            mesh.opacity[patch] = static_cast<float>(opacity);
            mesh.area[patch] *= static_cast<float>(std::max(opacity, kLeastOpacity));
        }
    });
}

} // namespace lambert
