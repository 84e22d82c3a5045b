// Drawing directions by a latitude-longitude picture: M. Pharr, W. Jakob, G. Humphreys, "Physically based rendering", 2023, 12.5.

#include "scene/environment.h"

#include "core/error.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace lambert {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::uint64_t kMostSkyTexels = std::uint64_t{1} << 26;

double luminance(const Rgb& rgb) {
    return 0.2126 * static_cast<double>(rgb.x) + 0.7152 * static_cast<double>(rgb.y) +
           0.0722 * static_cast<double>(rgb.z);
}

/// The height (sine of the elevation) at which a row begins; the last one ends at −1.
double rowTop(std::size_t row, std::size_t rows) {
    return std::cos(kPi * static_cast<double>(row) / static_cast<double>(rows));
}

glm::dvec3 directionOf(double azimuth, double height) {
    const double radius = std::sqrt(std::max(0.0, 1.0 - height * height));
    return {radius * std::sin(azimuth), height, -radius * std::cos(azimuth)};
}

std::size_t cellAt(double share, std::size_t count) {
    return std::min(static_cast<std::size_t>(std::max(share, 0.0) * static_cast<double>(count)), count - 1);
}

} // namespace

glm::dvec3 skyDirection(double azimuth, double elevation) {
    return directionOf(azimuth * kPi / 180.0, std::sin(elevation * kPi / 180.0));
}

SkyMapDistribution::SkyMapDistribution(std::size_t columns, std::size_t rows,
                                       const std::function<double(std::size_t, std::size_t)>& weight)
    : columns_(columns), rows_(rows), rowSums_(rows + 1, 0.0), columnShares_(columns * rows) {
    std::vector<double> sums(columns);
    for (std::size_t row = 0; row < rows; ++row) {
        double sum = 0.0;
        for (std::size_t column = 0; column < columns; ++column) sums[column] = sum += weight(column, row);
        rowSums_[row + 1] = rowSums_[row] + sum * solidAngle(row, columns, rows);
        if (!(sum > 0.0)) continue; // the row is never drawn
        std::transform(sums.begin(), sums.end(), columnShares_.begin() + static_cast<std::ptrdiff_t>(row * columns),
                       [&](double s) { return static_cast<float>(s / sum); });
    }
}

double SkyMapDistribution::solidAngle(std::size_t row, std::size_t columns, std::size_t rows) {
    return 2.0 * kPi / static_cast<double>(columns) * (rowTop(row, rows) - rowTop(row + 1, rows));
}

SkyMapDistribution::Cell SkyMapDistribution::cellOf(const glm::dvec3& direction, std::size_t columns,
                                                    std::size_t rows) {
    const double azimuth = std::atan2(direction.x, -direction.z);
    const double polar = std::acos(std::clamp(direction.y, -1.0, 1.0));
    return {cellAt(0.5 + azimuth / (2.0 * kPi), columns), cellAt(polar / kPi, rows)};
}

double SkyMapDistribution::weightOf(const Cell& cell) const {
    const float* row = columnShares_.data() + cell.row * columns_;
    return static_cast<double>(row[cell.column]) - (cell.column > 0 ? static_cast<double>(row[cell.column - 1]) : 0.0);
}

SkyMapDistribution::Sample SkyMapDistribution::sample(const glm::dvec2& u) const {
    // The first row and column that end above the number: never one of weight 0.
    const double target = u.y * total();
    const auto sum = std::min(std::upper_bound(rowSums_.begin() + 1, rowSums_.end(), target),
                              std::lower_bound(rowSums_.begin() + 1, rowSums_.end(), total()));
    const auto row = static_cast<std::size_t>(sum - rowSums_.begin()) - 1;
    const double inRow = std::clamp((target - rowSums_[row]) / (rowSums_[row + 1] - rowSums_[row]), 0.0, 1.0);

    const auto first = columnShares_.begin() + static_cast<std::ptrdiff_t>(row * columns_);
    const auto last = first + static_cast<std::ptrdiff_t>(columns_);
    const auto share =
        std::min(std::upper_bound(first, last, static_cast<float>(u.x)), std::lower_bound(first, last, last[-1]));
    const Cell cell{static_cast<std::size_t>(share - first), row};
    const double before = cell.column > 0 ? static_cast<double>(share[-1]) : 0.0;
    const double weight = weightOf(cell);
    const double inColumn = std::clamp((u.x - before) / weight, 0.0, 1.0);

    const double azimuth =
        2.0 * kPi * ((static_cast<double>(cell.column) + inColumn) / static_cast<double>(columns_) - 0.5);
    const double height = rowTop(row, rows_) + inRow * (rowTop(row + 1, rows_) - rowTop(row, rows_));
    const double rowShare = (rowSums_[row + 1] - rowSums_[row]) / total();
    return {directionOf(azimuth, height), rowShare * weight / solidAngle(row, columns_, rows_)};
}

double SkyMapDistribution::density(const glm::dvec3& direction) const {
    const Cell cell = cellOf(direction, columns_, rows_);
    const double rowShare = (rowSums_[cell.row + 1] - rowSums_[cell.row]) / total();
    return rowShare * weightOf(cell) / solidAngle(cell.row, columns_, rows_);
}

Environment Environment::constant(const Rgb& radiance) {
    Environment result;
    result.radiance_ = [radiance](const glm::dvec3&) { return radiance; };
    result.dark_ = radiance == Rgb(0.0F);
    return result;
}

Environment Environment::image(std::shared_ptr<const Texture> image) {
    Environment result;
    const auto columns = static_cast<std::size_t>(image->width());
    const auto rows = static_cast<std::size_t>(image->height());
    const auto at = [image](std::size_t column, std::size_t row) {
        return Rgb(image->texel(static_cast<int>(column), static_cast<int>(row)));
    };
    result.distribution_ = std::make_shared<SkyMapDistribution>(
        columns, rows, [&](std::size_t column, std::size_t row) { return luminance(at(column, row)); });
    result.radiance_ = [=](const glm::dvec3& direction) {
        const auto cell = SkyMapDistribution::cellOf(direction, columns, rows);
        return at(cell.column, cell.row);
    };
    result.dark_ = !(result.distribution_->total() > 0.0);
    if (result.dark_) result.distribution_ = nullptr;
    return result;
}

Environment Environment::function(std::function<Rgb(const glm::dvec3&)> radiance) {
    constexpr std::size_t kColumns = 360, kRows = 180;
    Environment result;
    result.distribution_ =
        std::make_shared<SkyMapDistribution>(kColumns, kRows, [&](std::size_t column, std::size_t row) {
            const double azimuth = static_cast<double>(column) + 0.5 - 180.0;
            return luminance(radiance(skyDirection(azimuth, 89.5 - static_cast<double>(row))));
        });
    result.radiance_ = std::move(radiance);
    result.dark_ = !(result.distribution_->total() > 0.0);
    if (result.dark_) result.distribution_ = nullptr;
    return result;
}

Environment readEnvironment(const std::filesystem::path& path) {
    try {
        return Environment::image(readTexture(path, TextureContent::Colour, kMostSkyTexels));
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", path.string(), error.what()));
    }
}

} // namespace lambert
