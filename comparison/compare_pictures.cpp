#include "comparison/compare_pictures.h"

#include "comparison/flip.h"
#include "core/stopwatch.h"
#include "picture/tone_mapping.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace lambert {

namespace {

constexpr double kPercentile = 0.99;
constexpr double kDisplayValue = 0.9; ///< of the percentile, as automaticExposure has it
constexpr double kLeastMedian =
    0.08; ///< what half of a picture has at least: with one lit spot in a dark room all else is to be seen

/// The EV at which the 99th percentile of what does not shine by itself becomes 0.9, or its median 0.08 if that is
/// brighter.
float exposureOf(const Image& image, const PixelPoints& pixels) {
    std::vector<float> values;
    for (const std::uint32_t pixel : pixels.pixel) {
        const Rgb& c = image.pixels[pixel];
        if (!pixels.emits[pixel]) values.push_back(std::max({c.x, c.y, c.z}));
    }
    if (values.empty()) return 0.0F;
    const auto factor = [&](double share, double shown) {
        const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
        std::nth_element(values.begin(), place, values.end());
        return *place > 0.0F ? shown / static_cast<double>(*place) : 0.0;
    };
    const double largest = std::max(factor(kPercentile, kDisplayValue), factor(0.5, kLeastMedian));
    return largest > 0.0 ? static_cast<float>(std::log2(largest)) : 0.0F;
}

std::vector<RgbSum> pixelsOf(const Image& image) {
    std::vector<RgbSum> result;
    for (const Rgb& pixel : image.pixels) result.emplace_back(pixel);
    return result;
}

ComparedPicture compared(const Image& light, const VplPictures& pictures) {
    ComparedPicture result;
    result.light = light;
    const std::vector<double> weight(light.pixels.size(), 1.0);
    const std::vector<RgbSum> reference = pixelsOf(pictures.reference);
    const std::vector<RgbSum> found = pixelsOf(light);
    result.errors = lightErrors(weight, reference, found);
    const double mean = result.errors.overall.mean;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const RgbSum off = glm::abs(found[i] - reference[i]);
        result.relativeError.push_back(mean > 0.0 ? static_cast<float>((off.x + off.y + off.z) / (3.0 * mean)) : 0.0F);
    }
    const Image shownReference = toneMapped(pictures.reference, pictures.exposure);
    const Image shown = toneMapped(light, pictures.exposure);
    result.psnr = peakSignalToNoise(shownReference, shown);
    result.flipMap = flipMap(shownReference, shown);
    result.flip = meanOf(result.flipMap);
    return result;
}

double sumOf(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Over pixels and channels; above 0.
double meanOf(const Image& image) {
    double sum = 0.0;
    for (const Rgb& c : image.pixels) sum += static_cast<double>(c.x + c.y + c.z);
    return std::max(sum / (3.0 * static_cast<double>(image.pixels.size())), 1e-300);
}

} // namespace

Image toneMapped(const Image& radiance, float exposure) {
    Image image = radiance;
    for (Rgb& pixel : image.pixels) pixel = toneMap(pixel, exposure);
    image.content = PixelContent::Display;
    return image;
}

VplPictures comparePictures(const MeshedScene& scene, const RadiosityReference& reference,
                            const VplComparisonOptions& options, const PictureOptions& picture, Progress& progress) {
    const PixelPoints pixels = pixelPoints(*scene.rays, picture.camera, picture.size.width, picture.size.height);
    VplPictures result;
    result.camera = picture.camera;
    options.onStage("reference's picture");
    // In units of what the eye gets: ρ / π of the irradiance.
    std::vector<double> weight;
    for (const Rgb& rho : pixels.reflectance)
        weight.push_back(static_cast<double>((rho.x + rho.y + rho.z) * (rho.x + rho.y + rho.z)) / 9.0 + 1e-12);
    if (pixels.receivers.empty()) {
        result.reference = pixels.unlit;
    } else {
        const ReferenceLight light = reference.at(pixels.receivers, weight, picture.gathering, progress);
        result.reference = pixels.picture(light.irradiance);
        result.ownError = light.rms.total() *
                          std::sqrt(sumOf(weight) / static_cast<double>(pixels.unlit.pixels.size())) /
                          (std::numbers::pi * meanOf(result.reference));
    }
    result.exposure = exposureOf(result.reference, pixels);
    for (const auto& method : options.methods) {
        options.onStage(method->name() + ", picture");
        const Stopwatch watch;
        const VplView view{pixels.receivers,
                           PictureView{picture.camera, picture.size.width, picture.size.height, pixels.pixel}};
        const MethodLight light = method->light(*scene.rays, view, options.effort, options.seed, progress);
        const double seconds = watch.seconds();
        result.methods.push_back(compared(pixels.picture(light.irradiance), result));
        result.methods.back().seconds = seconds;
    }
    return result;
}

} // namespace lambert
