#include "comparison/page_files.h"

#include "comparison/html_page.h"
#include "comparison/scale_bar.h"

namespace lambert {

std::string PageFiles::picture(const std::string& name, const Image& image, const std::string& alternative,
                               const ColourScale* scale) {
    const Image file = scale != nullptr ? withScaleBar(image, *scale) : image;
    files.push_back({name + ".png", encodeImage(file, ImageFormat::Png, 0.0F)});
    const std::string png = scale != nullptr ? encodeImage(image, ImageFormat::Png, 0.0F) : files.back().content;
    return htmlPng(png, image.width, image.height, alternative);
}

std::string PageFiles::plot(const Plot& plot, const Progress& progress) {
    std::string svg = plotSvg(plot, progress);
    files.push_back({plot.name + ".svg", svg});
    return svg;
}

void PageFiles::radiance(const std::string& name, const Image& image) {
    files.push_back({name + ".exr", encodeImage(image, ImageFormat::Exr, 0.0F)});
}

} // namespace lambert
