#include "rendering/render.h"

#include "baking/interpolation.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "picture/camera_rays.h"
#include "picture/tone_mapping.h"
#include "scene/environment.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <optional>

namespace lambert {

namespace {

constexpr int kTile = 4;             ///< pixels along an edge; a packet has one ray per pixel
constexpr int kMostOccluders = 1000; ///< that one ray passes
static_assert(kTile * kTile == RayPacket::kSize);

class TileRenderer {
public:
    TileRenderer(const PatchMesh& mesh, const BakedMesh& baked, const RayCaster& caster, const Camera& camera,
                 const RenderOptions& options)
        : mesh_(mesh),
          baked_(baked),
          caster_(caster),
          eye_(camera.eye),
          rays_(camera, options.width, options.height),
          options_(options) {}

    /// Fills the pixels of the tile whose upper left pixel is (left, top).
    void render(int left, int top, Image& image) const {
        Rgb sums[RayPacket::kSize];
        std::fill(std::begin(sums), std::end(sums), Rgb(0.0F));
        RayPacket packet;
        const int samples = options_.samplesPerAxis * options_.samplesPerAxis;
        for (int sample = 0; sample < samples; ++sample) {
            aim(left, top, sample, packet);
            caster_.closest(eye_, packet);
            for (int lane = 0; lane < RayPacket::kSize; ++lane) sums[lane] += shown(packet, lane);
        }
        for (int lane = 0; lane < RayPacket::kSize; ++lane)
            if (packet.active[lane] != 0)
                image.at(left + lane % kTile, top + lane / kTile) = sums[lane] / static_cast<float>(samples);
    }

private:
    /// Stratified in n × n cells, and in n² strips along each axis as well (multi-jittered sampling, K. Chiu,
    /// P. Shirley, C. Wang, Graphics Gems IV, 1994): an upright or level edge is resolved to 1/n² of a pixel.
    glm::vec2 placeInPixel(int sample, const glm::vec2& jitter) const {
        const auto n = static_cast<float>(options_.samplesPerAxis);
        const auto column = static_cast<float>(sample % options_.samplesPerAxis);
        const auto row = static_cast<float>(sample / options_.samplesPerAxis);
        return {(column + (row + jitter.x) / n) / n, (row + (column + jitter.y) / n) / n};
    }

    /// One ray per pixel of the tile, all through the same cell of their pixel.
    void aim(int left, int top, int sample, RayPacket& packet) const {
        for (int lane = 0; lane < RayPacket::kSize; ++lane) {
            const int x = left + lane % kTile;
            const int y = top + lane / kTile;
            const auto bits = philox(
                {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(sample), 0},
                options_.seed);
            const glm::vec2 place = placeInPixel(sample, {uniformFloat(bits[0]), uniformFloat(bits[1])});
            packet.aim(lane, rays_.direction(static_cast<float>(x) + place.x, static_cast<float>(y) + place.y),
                       x < options_.width && y < options_.height);
        }
    }

    Rgb shown(const RayPacket& packet, int lane) const {
        const Rgb radiance = radianceOf(packet, lane);
        return options_.toneMapExposure ? toneMap(radiance, *options_.toneMapExposure) : radiance;
    }

    Rgb radianceOf(const RayPacket& packet, int lane) const {
        const glm::vec3 direction{packet.directionX[lane], packet.directionY[lane], packet.directionZ[lane]};
        if (packet.polygon[lane] == kNone) return beyondTheScene(direction);
        const Hit hit{packet.polygon[lane], packet.u[lane], packet.v[lane], 0.0F, packet.facing[lane] < 0.0F};
        if (!isOccluder(caster_.scene(), caster_.scene().polygons[hit.polygon])) return radianceAt(hit);
        const auto beyond = behindOccluders(hit, direction);
        return beyond ? radianceAt(*beyond) : beyondTheScene(direction);
    }

    Rgb beyondTheScene(const glm::vec3& direction) const {
        const auto& environment = caster_.scene().environment;
        return environment ? environment->radiance(glm::normalize(glm::dvec3(direction))) : options_.background;
    }

    /// What a ray that has met an occluder would meet without it: what is not in the mesh is not in its picture.
    std::optional<Hit> behindOccluders(Hit hit, const glm::vec3& direction) const {
        const Scene& scene = caster_.scene();
        const float step = 4.0F * caster_.originOffset(0.0F) / glm::length(direction);
        for (int passed = 0; passed < kMostOccluders; ++passed) {
            const glm::vec3 point = polygonPoint(scene, hit.polygon, hit.u, hit.v);
            const auto next = caster_.closest(Ray{point + step * direction, direction});
            if (!next || !isOccluder(scene, scene.polygons[next->polygon])) return next;
            hit = *next;
        }
        return std::nullopt;
    }

    Rgb radianceAt(const Hit& hit) const {
        std::uint32_t patch = mesh_.lookup.patchAt(hit.polygon, hit.u, hit.v);
        if (!hit.front) patch = mesh_.lookup.backPatch(hit.polygon, patch);
        if (patch == kNone) return Rgb(0.0F);
        const glm::vec3 point = polygonPoint(caster_.scene(), hit.polygon, hit.u, hit.v);
        const InterpolationWeights weights = interpolationWeights(mesh_, patch, point);
        const Quantity quantity = isEmitter(baked_, patch) ? Quantity::Radiosity : options_.quantity;
        Rgb radiance(0.0F);
        for (std::size_t k = 0; k < (baked_.isQuad(patch) ? 4U : 3U); ++k)
            radiance += static_cast<float>(weights[k]) * shownRadiance(baked_, baked_.faces[patch][k], quantity);
        return radiance;
    }

    const PatchMesh& mesh_;
    const BakedMesh& baked_;
    const RayCaster& caster_;
    glm::vec3 eye_;
    CameraRays rays_;
    const RenderOptions& options_;
};

void requireInRange(const RenderOptions& options) {
    if (options.width < 1 || options.height < 1)
        throw UsageError(fmt::format("picture size {}x{}: both must be at least 1", options.width, options.height));
    if (options.samplesPerAxis < 1 || options.samplesPerAxis > 64)
        throw UsageError(fmt::format("{} samples per axis of a pixel: 1 to 64 are allowed", options.samplesPerAxis));
}

} // namespace

Image renderBaked(const PatchMesh& mesh, const BakedMesh& baked, const RayCaster& caster, const Camera& camera,
                  const RenderOptions& options, Progress& progress) {
    requireInRange(options);
    Image image;
    image.width = options.width;
    image.height = options.height;
    image.pixels.resize(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height));
    image.content = options.toneMapExposure ? PixelContent::Display : PixelContent::Radiance;

    const TileRenderer renderer(mesh, baked, caster, camera, options);
    const auto columns = static_cast<std::size_t>((options.width + kTile - 1) / kTile);
    const auto rows = static_cast<std::size_t>((options.height + kTile - 1) / kTile);
    progress.begin("picture", columns * rows);
    parallelFor(columns * rows, 64, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t tile = begin; tile < end; ++tile)
            renderer.render(static_cast<int>(tile % columns) * kTile, static_cast<int>(tile / columns) * kTile, image);
        progress.advance(end - begin);
    });
    progress.end();
    return image;
}

} // namespace lambert
