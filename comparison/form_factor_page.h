#pragma once

#include "comparison/compare_form_factors.h"
#include "comparison/patch_picture.h"
#include "core/whole_file.h"

#include <string>
#include <utility>
#include <vector>

namespace lambert {

/// What the page shows.
struct FormFactorPageInput {
    std::string scene; //!< its file's name
    const MeshedScene& meshed;
    const FormFactorComparison& comparison;
    std::vector<std::pair<std::string, std::string>>
        facts; //!< further lines of the table beside the picture: name, value
    Camera camera;
    PictureSize size;
};

/// index.html with all pictures and plots inside it, and the same as .png and .svg files; paths are within the page's folder. Throws SystemError (gnuplot),
/// Cancelled.
std::vector<FileContent> formFactorPage(const FormFactorPageInput& input, Progress& progress);

} // namespace lambert
