#include "comparison/compared_points.h"

#include "meshing/patch_offset.h"
#include "picture/camera_rays.h"
#include "scene/environment.h"
#include "scene/surface.h"
#include "vpl/particle_sources.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace lambert {

ComparedPoints patchCentres(const PatchMesh& mesh, const RayCaster& rays, std::vector<std::uint32_t>& patches) {
    ComparedPoints points;
    patches.clear();
    for (std::uint32_t i = 0; i < mesh.size(); ++i) {
        if (!(mesh.area[i] > 0.0F)) continue;
        patches.push_back(i);
        points.receivers.push_back({mesh.centroid[i], mesh.normal[i], patchOriginOffset(rays, mesh, i)});
        points.weight.push_back(static_cast<double>(mesh.area[i]));
    }
    return points;
}

Image PixelPoints::picture(std::span<const RgbSum> irradiance) const {
    Image image = unlit;
    for (std::size_t i = 0; i < receivers.size(); ++i)
        image.pixels[pixel[i]] += Rgb(RgbSum(reflectance[i]) * irradiance[i] / std::numbers::pi);
    return image;
}

PixelPoints pixelPoints(const RayCaster& rays, const Camera& camera, int width, int height) {
    PixelPoints points;
    points.unlit.width = width;
    points.unlit.height = height;
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    points.unlit.pixels.assign(count, Rgb(0.0F));
    points.emits.assign(count, false);
    const CameraRays through(camera, width, height);
    const Scene& scene = rays.scene();
    for (std::uint32_t pixel = 0; pixel < count; ++pixel) {
        const auto x = static_cast<float>(pixel % static_cast<std::uint32_t>(width)) + 0.5F;
        const auto y = static_cast<float>(pixel / static_cast<std::uint32_t>(width)) + 0.5F;
        const glm::vec3 direction = through.direction(x, y);
        const auto hit = rays.closest({camera.eye, direction});
        if (!hit) {
            points.emits[pixel] = true;
            if (scene.environment)
                points.unlit.pixels[pixel] = scene.environment->radiance(glm::normalize(glm::dvec3(direction)));
            continue;
        }
        const Polygon& polygon = scene.polygons[hit->polygon];
        const SurfaceSide side = sideOf(scene, polygon, hit->front);
        if (!side) continue;
        points.unlit.pixels[pixel] = emittedRadianceAt(scene, polygon, side, hit->u, hit->v);
        points.emits[pixel] = points.unlit.pixels[pixel] != Rgb(0.0F);
        const SurfacePoint point = surfacePoint(rays, hit->polygon, hit->front, hit->u, hit->v);
        points.receivers.push_back({point.position, point.normal, point.lift});
        points.pixel.push_back(pixel);
        points.reflectance.push_back(reflectanceAt(scene, polygon, side, hit->u, hit->v));
    }
    return points;
}

} // namespace lambert
