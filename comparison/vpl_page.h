#pragma once

#include "comparison/compare_pictures.h"
#include "core/whole_file.h"

#include <string>
#include <utility>
#include <vector>

namespace lambert {

/// What the page shows.
struct VplPageInput {
    std::string scene; //!< its file's name
    const MeshedScene& meshed;
    const VplComparison& comparison;
    const VplPictures& pictures;
    std::vector<std::pair<std::string, std::string>>
        facts; //!< further lines of the table beside the picture: name, value
};

/// index.html with all pictures and plots inside it, and the same as .png, .exr and .svg files; paths are within the page's
/// folder. Throws SystemError (gnuplot), Cancelled.
std::vector<FileContent> vplPage(const VplPageInput& input, Progress& progress);

} // namespace lambert
