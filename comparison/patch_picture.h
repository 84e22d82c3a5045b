#pragma once

#include "comparison/page/colour_scale.h"
#include "core/progress.h"
#include "meshing/patch_optics.h"
#include "rendering/render.h"

#include <span>

namespace lambert {

/// The scene with each patch in its own grey, by how it is turned to the camera: for scenes without light.
Image headlightPicture(const PatchMesh& mesh, const PatchOptics& optics, const RayCaster& rays, const Camera& camera,
                       const PictureSize& size, Progress& progress);

/// The scene with each patch in the colour of its value (#patches), on a neutral grey. Of display colours. Throws Cancelled.
Image patchPicture(const PatchMesh& mesh, const RayCaster& rays, std::span<const float> values,
                   const ColourScale& scale, const Camera& camera, const PictureSize& size, Progress& progress);

} // namespace lambert
