#include "scene/obj/vertices.h"

#include "picture/srgb.h"
#include "scene/obj/material.h"
#include "scene/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lambert {

namespace {

/// The tint of vertices without a colour among others that have one: with the substitute's reflectance, the usual grey.
constexpr float kTintWithoutColour = kUnknownReflectance / kMaxReflectance;

class VertexReader {
public:
    VertexReader(ObjLines& lines, double metresPerUnit, SceneBuilder& builder)
        : lines_(lines), metresPerUnit_(metresPerUnit), builder_(builder) {}

    ObjVertices run() {
        while (const auto line = lines_.next()) readStatement(*line);
        if (!result_.tints.empty()) result_.tints.resize(result_.positions, Rgb(kTintWithoutColour));
        if (coloursOutside_ > 0)
            builder_.warn(fmt::format("{} vertex colours are not within 0 to 1 and were clamped", coloursOutside_));
        return std::move(result_);
    }

private:
    void readStatement(const ObjLine& line) {
        const std::string_view keyword = line.keyword;
        if (keyword == "v") {
            readPosition(line);
        } else if (keyword == "vn") {
            readNumbers(line, 3);
        } else if (keyword == "vt") {
            const std::size_t count = readNumbers(line, 1);
            result_.uv.emplace_back(static_cast<float>(numbers_[0]),
                                    count > 1 ? static_cast<float>(numbers_[1]) : 0.0F);
        } else if (keyword == "f" || keyword == "fo") {
            ++result_.faces;
        } else if (keyword == "mtllib") {
            if (!line.rest.empty()) result_.libraries.emplace_back(line.rest);
        } else if (keyword == "p" || keyword == "l") {
            ++result_.pointsAndLines;
        } else if (keyword == "curv" || keyword == "curv2" || keyword == "surf") {
            ++result_.curvesAndSurfaces;
        }
    }

    /// Reads up to 7 numbers into numbers_, at least `fewest`, and returns how many there are.
    std::size_t readNumbers(const ObjLine& line, std::size_t fewest) {
        std::string_view rest = line.rest;
        std::size_t count = 0;
        for (; count < numbers_.size(); ++count) {
            const std::string_view word = nextWord(rest);
            if (word.empty() && count >= fewest) break;
            const auto number = parseNumber(word);
            if (!number)
                failAt(lines_.file(), line.number, word.empty() ? line.text : word,
                       fmt::format("{} number{} after {}", fewest, fewest > 1 ? "s" : "", line.keyword));
            numbers_[count] = *number;
        }
        return count;
    }

    /// `x y z`, with a weight that polygons do not have, or with `r g b` and perhaps an opacity.
    void readPosition(const ObjLine& line) {
        const std::size_t count = readNumbers(line, 3);
        builder_.addPosition(glm::dvec3(numbers_[0], numbers_[1], numbers_[2]) * metresPerUnit_);
        if (count >= 6) {
            result_.tints.resize(result_.positions, Rgb(kTintWithoutColour));
            result_.tints.push_back(readTint());
        }
        ++result_.positions;
    }

    Rgb readTint() {
        Rgb tint;
        bool outside = false;
        for (int channel = 0; channel < 3; ++channel) {
            const double encoded = numbers_[static_cast<std::size_t>(channel) + 3];
            outside |= !(encoded >= 0.0 && encoded <= 1.0);
            tint[channel] = std::isnan(encoded) ? 0.0F : static_cast<float>(srgbDecoded(std::clamp(encoded, 0.0, 1.0)));
        }
        if (outside) ++coloursOutside_;
        return tint;
    }

    ObjLines& lines_;
    double metresPerUnit_;
    SceneBuilder& builder_;
    ObjVertices result_;
    std::array<double, 7> numbers_{};
    std::size_t coloursOutside_ = 0;
};

} // namespace

ObjVertices readObjVertices(ObjLines& lines, double metresPerUnit, SceneBuilder& builder) {
    return VertexReader(lines, metresPerUnit, builder).run();
}

} // namespace lambert
