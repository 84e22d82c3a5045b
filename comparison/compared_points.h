#pragma once

#include "meshing/patch_mesh.h"
#include "picture/image.h"
#include "scene/rays/ray_caster.h"
#include "solver/solution.h"
#include "vpl/receiver.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// Points of surfaces at which light is compared, and how much each counts.
struct ComparedPoints {
    std::vector<Receiver> receivers;
    std::vector<double> weight; //!< #receivers, above 0
};

/// The centres of patches that have an area, weighted by it; `patches` becomes the patch of each.
ComparedPoints patchCentres(const PatchMesh& mesh, const RayCaster& rays, std::vector<std::uint32_t>& patches);

/// What the middles of a picture's pixels show.
struct PixelPoints {
    std::vector<Receiver> receivers;
    std::vector<std::uint32_t> pixel; //!< #receivers: row by row from the top
    std::vector<Rgb> reflectance;     //!< #receivers
    Image unlit;                      //!< radiance of what shines by itself: emitters, the environment; black elsewhere
    std::vector<bool> emits;          //!< #pixels: whether it shows an emitter or what lies beyond the scene

    /// The picture of such a light at the receivers (E per m²): L = L_e + ρ E / π.
    Image picture(std::span<const RgbSum> irradiance) const;
};

/// One ray through the middle of every pixel. What is black has no receiver.
PixelPoints pixelPoints(const RayCaster& rays, const Camera& camera, int width, int height);

} // namespace lambert
