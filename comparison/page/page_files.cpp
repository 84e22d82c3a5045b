#include "comparison/page/page_files.h"

#include "comparison/page/scale_bar.h"

namespace lambert {

std::string PageFiles::picture(const std::string& name, const Image& image, const std::string& alternative,
                               const ColourScale* scale) {
    const Image file = scale != nullptr ? withScaleBar(image, *scale) : image;
    files_.push_back({name + ".png", encodeImage(file, ImageFormat::Png, 0.0F)});
    const std::string png = scale != nullptr ? encodeImage(image, ImageFormat::Png, 0.0F) : files_.back().content;
    return htmlPng(png, image.width, image.height, alternative);
}

std::string PageFiles::drawing(const std::string& name, std::string svg) {
    files_.push_back({name + ".svg", svg});
    return svg;
}

std::string PageFiles::plot(const Plot& plot, const Progress& progress) {
    return drawing(plot.name, plotSvg(plot, progress));
}

void PageFiles::radiance(const std::string& name, const Image& image) {
    files_.push_back({name + ".exr", encodeImage(image, ImageFormat::Exr, 0.0F)});
}

std::vector<FileContent> PageFiles::with(const HtmlPage& page) {
    files_.insert(files_.begin(), {"index.html", page.text()});
    return std::move(files_);
}

} // namespace lambert
