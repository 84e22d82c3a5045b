#include "comparison/patch_picture.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace lambert {

namespace {

constexpr Rgb kGround(0.22F); ///< linear; lighter than the scale's dark end, darker than its light one

/// A mesh whose patches share no vertices, each of one radiosity: what is shown of it is flat.
BakedMesh flatMesh(const PatchMesh& mesh, std::span<const Rgb> colours) {
    BakedMesh flat;
    for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
        const Rgb radiosity = std::numbers::pi_v<float> * colours[patch];
        std::array<std::uint32_t, 4> face{kNone, kNone, kNone, kNone};
        for (int k = 0; k < mesh.cornerCount(patch); ++k) {
            face[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(flat.positions.size());
            flat.positions.push_back(mesh.position(patch, k));
            flat.normals.push_back(mesh.normal[patch]);
            flat.radiosity.push_back(radiosity);
            flat.irradiance.push_back(radiosity);
        }
        flat.faces.push_back(face);
    }
    flat.faceMaterials.assign(mesh.size(), 0);
    return flat;
}

/// The scene with each patch in one colour (#patches, linear display colours), on a neutral grey. Throws Cancelled.
Image flatPicture(const PatchMesh& mesh, const RayCaster& rays, std::span<const Rgb> colours, const Camera& camera,
                  const PictureSize& size, Progress& progress) {
    RenderOptions options{size};
    options.background = kGround;
    Image image = renderBaked(mesh, flatMesh(mesh, colours), rays, camera, options, progress);
    image.content = PixelContent::Display;
    return image;
}

} // namespace

Image headlightPicture(const PatchMesh& mesh, const PatchOptics& optics, const RayCaster& rays, const Camera& camera,
                       const PictureSize& size, Progress& progress) {
    std::vector<Rgb> colours;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const glm::vec3 toEye = glm::normalize(camera.eye - mesh.centroid[i]);
        colours.push_back((0.1F + 0.8F * std::abs(glm::dot(mesh.normal[i], toEye))) *
                          (0.3F + 0.7F * optics.reflectance[i]));
    }
    return flatPicture(mesh, rays, colours, camera, size, progress);
}

Image patchPicture(const PatchMesh& mesh, const RayCaster& rays, std::span<const float> values,
                   const ColourScale& scale, const Camera& camera, const PictureSize& size, Progress& progress) {
    std::vector<Rgb> colours;
    for (const float value : values) colours.push_back(linearDisplay(scale.colour(value)));
    return flatPicture(mesh, rays, colours, camera, size, progress);
}

} // namespace lambert
