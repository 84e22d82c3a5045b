#pragma once

#include "comparison/compare_vpl.h"
#include "rendering/render.h"

#include <optional>
#include <vector>

namespace lambert {

/// A method's picture beside that of the reference: of radiance, one ray through the middle of each pixel.
struct ComparedPicture {
    Image light;                      //!< radiance
    LightErrors errors;               //!< over all pixels, of radiance
    double psnr = 0.0;                //!< see peakSignalToNoise, of the tone-mapped pictures
    double flip = 0.0;                //!< mean of flipMap
    std::vector<float> flipMap;       //!< #pixels
    std::vector<float> relativeError; //!< #pixels: |L − L_ref| / mean L_ref, mean of the channels
    double seconds = 0.0;             //!< on the clock
};

struct VplPictures {
    Camera camera;
    Image reference;                      //!< radiance
    float exposure = 0.0F;                //!< EV by which all are tone-mapped
    double ownError = 0.0;                //!< relative RMS, of the reference's picture
    std::vector<ComparedPicture> methods; //!< in the order of the comparison
};

struct PictureOptions {
    Camera camera;
    PictureSize size; //!< of which one sample per pixel
    PointGatherOptions gathering{.cells = 24, .emitterRays = 256, .skyRays = 256};
};

/// Pictures by all methods at the effort of their anatomies with the first seed, and by the reference. Throws Cancelled.
VplPictures comparePictures(const MeshedScene& scene, const RadiosityReference& reference,
                            const VplComparisonOptions& options, const PictureOptions& picture, Progress& progress);

/// As a display shows it: linear display colours.
Image toneMapped(const Image& radiance, float exposure);

} // namespace lambert
