#include "scene/texel_average.h"

#include "scene/surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lambert {

namespace {

constexpr int kBlock = 32; ///< texels between two stored sums: a quarter of what the image itself takes
constexpr double kMostCrossings = 65536.0;
constexpr int kCoarseSize = 64;
/// A polygon flatter than this is a line: of its area, rounding would leave less than six digits.
constexpr double kFlat = 1e-9;

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

double signedArea(std::span<const glm::dvec2> border) {
    double sum = 0.0;
    for (std::size_t k = 2; k < border.size(); ++k) sum += cross(border[k - 1] - border[0], border[k] - border[0]);
    return 0.5 * sum;
}

/// An image's size along an axis once it is coarser; with `Clamp` the border texels must stay what they are.
int coarseSize(int size, bool bounded) {
    if (bounded) return size;
    return size > kCoarseSize ? kCoarseSize : 1;
}

} // namespace

std::int64_t TexelAverage::Axis::cellAt(double place) const {
    if (bounded()) return static_cast<std::int64_t>(std::clamp(place, 0.0, static_cast<double>(size - 1)));
    return static_cast<std::int64_t>(std::floor(place));
}

int TexelAverage::Axis::texel(std::int64_t cell) const {
    return bounded() ? static_cast<int>(cell) : wrappedTexel(cell, size, wrap);
}

double TexelAverage::Axis::lines(double from, double to) const {
    return bounded() ? std::min(std::abs(to - from), static_cast<double>(size)) : std::abs(to - from);
}

TexelAverage::TexelAverage(int width, int height, TextureWrap wrapU, TextureWrap wrapV, Field field)
    : columns_{width, wrapU},
      rows_{height, wrapV},
      field_(std::move(field)),
      blocks_(static_cast<std::size_t>(width) / kBlock + 1) {
    before_.reserve(static_cast<std::size_t>(height) * blocks_);
    for (int y = 0; y < height; ++y) {
        glm::dvec4 sum(0.0);
        for (int x = 0; x < width; ++x) {
            if (x % kBlock == 0) before_.push_back(sum);
            sum += field_(x, y);
        }
        if (width % kBlock == 0) before_.push_back(sum);
    }
    if (columns_.bounded() && rows_.bounded()) return;
    const int coarseWidth = coarseSize(width, columns_.bounded());
    const int coarseHeight = coarseSize(height, rows_.bounded());
    auto cells = std::make_shared<std::vector<glm::dvec4>>();
    for (int y = 0; y < coarseHeight; ++y) {
        for (int x = 0; x < coarseWidth; ++x) {
            const glm::dvec2 lower(static_cast<double>(x) / coarseWidth, static_cast<double>(y) / coarseHeight);
            const glm::dvec2 upper((x + 1.0) / coarseWidth, (y + 1.0) / coarseHeight);
            cells->push_back(over(std::array<glm::dvec2, 4>{{lower, {upper.x, lower.y}, upper, {lower.x, upper.y}}}));
        }
    }
    coarser_ =
        std::make_unique<TexelAverage>(coarseWidth, coarseHeight, wrapU, wrapV, [cells, coarseWidth](int x, int y) {
            return (*cells)[static_cast<std::size_t>(y) * static_cast<std::size_t>(coarseWidth) +
                            static_cast<std::size_t>(x)];
        });
}

glm::dvec4 TexelAverage::over(std::span<const glm::dvec2> uv) const {
    const std::vector<glm::dvec2> border = inTexels(uv);
    if (coarser_ && crossings(border) > kMostCrossings) return coarser_->over(uv);
    glm::dvec2 lower = border[0];
    glm::dvec2 upper = border[0];
    for (const glm::dvec2& p : border) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    const double size = glm::distance(lower, upper);
    const double area = signedArea(border);
    if (!(std::abs(area) > kFlat * size * (size + 1.0))) return alongBorder(border);
    return integral(border) / area;
}

/// Corners in texels, moved by whole periods towards 0: less rounding, and no negative columns.
std::vector<glm::dvec2> TexelAverage::inTexels(std::span<const glm::dvec2> uv) const {
    glm::dvec2 lower = uv[0];
    for (const glm::dvec2& p : uv) lower = glm::min(lower, p);
    const auto start = [](const Axis& axis, double least) {
        return axis.bounded() ? 0.0 : axis.period() * std::floor(least / axis.period());
    };
    const glm::dvec2 origin(start(columns_, lower.x), start(rows_, lower.y));
    std::vector<glm::dvec2> border;
    border.reserve(uv.size());
    for (const glm::dvec2& p : uv) border.push_back((p - origin) * glm::dvec2(columns_.size, rows_.size));
    return border;
}

double TexelAverage::crossings(std::span<const glm::dvec2> border) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < border.size(); ++k) {
        const glm::dvec2& a = border[k];
        const glm::dvec2& b = border[(k + 1) % border.size()];
        sum += columns_.lines(a.x, b.x) + rows_.lines(a.y, b.y);
    }
    return sum;
}

/// Calls `visit(cell, from, to)` for the parts of an interval, from <= to, that lie in one cell each.
template <typename Visit>
void TexelAverage::forCells(const Axis& axis, double from, double to, Visit&& visit) {
    const std::int64_t last = axis.cellAt(to);
    for (std::int64_t cell = axis.cellAt(from); cell < last; ++cell) {
        const auto line = static_cast<double>(cell + 1);
        visit(cell, from, line);
        from = line;
    }
    visit(last, from, to);
}

/// Calls `visit(row, part's begin, part's end)` for the parts of a line, from.y <= to.y, that lie in one row each.
template <typename Visit>
void TexelAverage::forRows(const Axis& axis, const glm::dvec2& from, const glm::dvec2& to, Visit&& visit) {
    const double height = to.y - from.y;
    forCells(axis, from.y, to.y, [&](std::int64_t cell, double low, double high) {
        const auto at = [&](double y) { return glm::dvec2(from.x + (y - from.y) / height * (to.x - from.x), y); };
        visit(axis.texel(cell), low == from.y ? from : at(low), high == to.y ? to : at(high));
    });
}

/// ∬ f dx dy, signed as the border's area.
glm::dvec4 TexelAverage::integral(std::span<const glm::dvec2> border) const {
    double left = border[0].x;
    for (const glm::dvec2& p : border) left = std::min(left, p.x);
    const std::int64_t origin = columns_.cellAt(left);
    // F begins at the border's left end: the smaller it is, the less rounding.
    const auto begin = [&](std::int64_t cell) { return cell == origin ? left : static_cast<double>(cell); };
    const auto fBefore = [&](int row, std::int64_t cell) {
        if (cell == origin) return glm::dvec4(0.0);
        return sumBefore(row, cell) - sumBefore(row, origin) -
               (left - static_cast<double>(origin)) * value(origin, row);
    };
    glm::dvec4 sum(0.0);
    for (std::size_t k = 0; k < border.size(); ++k) {
        const glm::dvec2& a = border[k];
        const glm::dvec2& b = border[(k + 1) % border.size()];
        if (a.y == b.y) continue;
        const bool up = a.y < b.y;
        forRows(rows_, up ? a : b, up ? b : a, [&](int row, const glm::dvec2& from, const glm::dvec2& to) {
            const auto [low, high] = std::minmax(from.x, to.x);
            const double height = (up ? 1.0 : -1.0) * (to.y - from.y);
            const double width = high - low;
            glm::dvec4 before = fBefore(row, columns_.cellAt(low));
            forCells(columns_, low, high, [&](std::int64_t cell, double x0, double x1) {
                const glm::dvec4 f = value(cell, row);
                const double share = width > 0.0 ? (x1 - x0) / width : 1.0;
                sum += height * share * (before + 0.5 * ((x0 - begin(cell)) + (x1 - begin(cell))) * f);
                before += (static_cast<double>(cell + 1) - begin(cell)) * f;
            });
        });
    }
    return sum;
}

/// The mean along the border, which of a polygon without area runs to and fro on its line.
glm::dvec4 TexelAverage::alongBorder(std::span<const glm::dvec2> border) const {
    glm::dvec4 sum(0.0);
    double length = 0.0;
    for (std::size_t k = 0; k < border.size(); ++k) {
        const glm::dvec2& a = border[k];
        const glm::dvec2& b = border[(k + 1) % border.size()];
        const bool up = a.y <= b.y;
        forRows(rows_, up ? a : b, up ? b : a, [&](int row, const glm::dvec2& from, const glm::dvec2& to) {
            const double low = std::min(from.x, to.x); // not both as bindings: clang 14 captures none
            const double high = std::max(from.x, to.x);
            const double part = glm::distance(from, to);
            forCells(columns_, low, high, [&](std::int64_t cell, double x0, double x1) {
                const double share = part * (high > low ? (x1 - x0) / (high - low) : 1.0);
                sum += share * value(cell, row);
                length += share;
            });
        });
    }
    if (length > 0.0) return sum / length;
    return value(columns_.cellAt(border[0].x), rows_.texel(rows_.cellAt(border[0].y)));
}

/// The sum of the first `count` texels of a row.
glm::dvec4 TexelAverage::prefix(int row, int count) const {
    const int block = count / kBlock;
    glm::dvec4 sum = before_[static_cast<std::size_t>(row) * blocks_ + static_cast<std::size_t>(block)];
    for (int x = block * kBlock; x < count; ++x) sum += field_(x, row);
    return sum;
}

/// The sum of a row's texels from column 0 to the one before `column`, which is not negative.
glm::dvec4 TexelAverage::sumBefore(int row, std::int64_t column) const {
    if (columns_.bounded()) return prefix(row, static_cast<int>(column));
    const std::int64_t images = column / columns_.size;
    const auto rest = static_cast<int>(column % columns_.size);
    const glm::dvec4 whole = images > 0 ? prefix(row, columns_.size) : glm::dvec4(0.0);
    const bool mirrored = columns_.wrap == TextureWrap::Mirror && images % 2 != 0;
    const glm::dvec4 part = mirrored ? whole - prefix(row, columns_.size - rest) : prefix(row, rest);
    return static_cast<double>(images) * whole + part;
}

} // namespace lambert
