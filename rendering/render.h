#pragma once

#include "baking/baked_mesh.h"
#include "core/progress.h"
#include "meshing/patch_mesh.h"
#include "picture/image.h"
#include "scene/rays/ray_caster.h"

#include <optional>

namespace lambert {

struct PictureSize {
    int width = 512, height = 512; //!< pixels, >= 1
    int samplesPerAxis = 4;        //!< a pixel averages the square of it, stratified; 1 to 64
};

struct RenderOptions : PictureSize {
    Quantity quantity = Quantity::Radiosity; //!< what is shown; emitters show their radiosity in any case
    Rgb background{0.0F};                    //!< radiance where a ray leaves a scene that has no environment
    std::uint64_t seed = 0;                  //!< of the samples' places within a pixel

    /// EV at which every sample is tone-mapped before a pixel averages them: the picture is then of display
    /// colours. Without it the picture is of radiance, and edges of bright lights stay jagged when it is
    /// tone-mapped later.
    std::optional<float> toneMapExposure{};
};

/// A picture of a baked mesh by ray casting. `mesh` is the division of `caster`'s scene, face i of `baked`
/// its patch i (same corners in the same order). The back of a one-sided polygon is black.
///
/// The pixels do not depend on the number of threads. Throws UsageError if an option is out of range,
/// Cancelled.
Image renderBaked(const PatchMesh& mesh, const BakedMesh& baked, const RayCaster& caster, const Camera& camera,
                  const RenderOptions& options, Progress& progress);

} // namespace lambert
