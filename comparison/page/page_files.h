#pragma once

#include "comparison/page/colour_scale.h"
#include "comparison/page/html_page.h"
#include "comparison/page/plot.h"
#include "core/whole_file.h"
#include "picture/image.h"

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
    /// Keeps an `<svg>` element as NAME.svg and gives it back.
    std::string drawing(const std::string& name, std::string svg);
    /// Keeps a plot by its name as .svg and gives it as an `<svg>` element. Throws as plotSvg.
    std::string plot(const Plot& plot, const Progress& progress);
    /// Keeps an image of radiance as NAME.exr.
    void radiance(const std::string& name, const Image& image);

    /// The page as index.html, and all files kept; paths are within the folder. Leaves nothing here.
    std::vector<FileContent> with(const HtmlPage& page);

private:
    std::vector<FileContent> files_;
};

} // namespace lambert
