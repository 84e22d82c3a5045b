#pragma once

#include "comparison/compare_bakes.h"
#include "comparison/patch_picture.h"
#include "core/whole_file.h"

#include <string>
#include <utility>
#include <vector>

namespace lambert {

/// A picture for a file and for a page, of display colours.
struct DifferencePicture {
    Image image;
    ColourScale scale;
};

/// The reference's patches in the colour of |B − A|, relative to the mean of A. Throws InputError if no patch has any size, Cancelled.
DifferencePicture differencePicture(const StoredSolution& reference, const BakeComparison& comparison,
                                    const RayCaster& rays, const Camera& camera, const PictureSize& size,
                                    Progress& progress);

/// What the page shows.
struct BakePageInput {
    std::string nameA, nameB; //!< of the files
    const StoredSolution& a;
    const StoredSolution& b;
    Quantity quantity;
    const BakeComparison& comparison;
    std::vector<std::pair<std::string, std::string>> facts; //!< further lines of its table: name, value
    const RayCaster& rays;                                  //!< of a's scene, which has polygons
    Camera camera;
    PictureSize size;
};

/// index.html with all pictures inside it, and the same as .png files, those in false colour with their scale; paths are within the
/// page's folder. Throws Cancelled.
std::vector<FileContent> bakePage(const BakePageInput& input, Progress& progress);

} // namespace lambert
