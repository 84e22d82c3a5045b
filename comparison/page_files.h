#pragma once

#include "comparison/colour_scale.h"
#include "comparison/plot.h"
#include "core/whole_file.h"
#include "rendering/image.h"

#include <string>
#include <vector>

namespace lambert {

/// What stands in a page, and in the page's folder as a file of its own.
class PageFiles {
public:
    /// Keeps an image of display colours as NAME.png, above a scale's bar if there is one, and gives it as an `<img>` element without
    /// the bar. `alternative` is for who cannot see it.
    std::string picture(const std::string& name, const Image& image, const std::string& alternative,
                        const ColourScale* scale = nullptr);
    /// Keeps a plot by its name as .svg and gives it as an `<svg>` element. Throws as plotSvg.
    std::string plot(const Plot& plot, const Progress& progress);
    /// Keeps an image of radiance as NAME.exr.
    void radiance(const std::string& name, const Image& image);

    std::vector<FileContent> files; //!< paths are within the folder
};

} // namespace lambert
