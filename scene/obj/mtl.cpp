#include "scene/obj/mtl.h"

#include "core/text.h"
#include "scene/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace lambert {

namespace {

/// An option of a `map_…` statement and how many words follow it.
struct MapOption {
    std::string_view name;
    int fewest, most;
};
constexpr std::array<MapOption, 14> kMapOptions{{{"-s", 1, 3},
                                                 {"-o", 1, 3},
                                                 {"-t", 1, 3},
                                                 {"-mm", 2, 2},
                                                 {"-clamp", 1, 1},
                                                 {"-bm", 1, 1},
                                                 {"-boost", 1, 1},
                                                 {"-blendu", 1, 1},
                                                 {"-blendv", 1, 1},
                                                 {"-cc", 1, 1},
                                                 {"-imfchan", 1, 1},
                                                 {"-texres", 1, 1},
                                                 {"-type", 1, 1},
                                                 {"-colorspace", 1, 1}}};

std::optional<float> parseFinite(std::string_view word) {
    const auto number = parseNumber(word);
    if (!number || !(std::abs(*number) <= double{std::numeric_limits<float>::max()})) return std::nullopt;
    return static_cast<float>(*number);
}

/// The words after `option`, taken off `text`: between its fewest and its most, as long as they are numbers.
std::vector<std::string_view> takeArguments(const MapOption& option, std::string_view& text) {
    std::vector<std::string_view> words;
    while (std::cmp_less(words.size(), option.most)) {
        std::string_view after = text;
        const std::string_view word = nextWord(after);
        if (word.empty() || (std::cmp_greater_equal(words.size(), option.fewest) && !parseNumber(word))) break;
        words.push_back(word);
        text = after;
    }
    return words;
}

class MtlReader {
public:
    explicit MtlReader(ObjLines& lines) : lines_(lines) {}

    MtlFile run() {
        while (const auto line = lines_.next()) {
            if (line->keyword == "newmtl") {
                if (line->rest.empty())
                    result_.warnings.push_back(
                        fmt::format("line {}: a newmtl without a name was ignored, with what follows", line->number));
                result_.materials.push_back({.name = asUtf8(line->rest)});
                opacityIsGiven_ = false;
            } else if (!result_.materials.empty()) {
                readStatement(*line, result_.materials.back());
            } else if (line->keyword == "Kd" || line->keyword == "Ke") {
                fail(*line, line->text, "newmtl NAME before it");
            }
        }
        std::erase_if(result_.materials, [](const MtlMaterial& material) { return material.name.empty(); });
        return std::move(result_);
    }

private:
    void readStatement(const ObjLine& line, MtlMaterial& material) {
        const std::string_view keyword = line.keyword;
        if (keyword == "Kd") {
            material.diffuse = colour(line, Rgb(0.5F));
        } else if (keyword == "Ke") {
            material.emission = colour(line, Rgb(0.0F));
        } else if (keyword == "Ks") {
            material.specular = specular(line);
        } else if (keyword == "map_Kd") {
            material.diffuseMap = map(line);
        } else if (keyword == "map_Ke") {
            material.emissionMap = map(line);
        } else if (keyword == "map_d") {
            material.opacityMap = map(line);
        } else if (keyword == "d") {
            material.opacity = firstNumber(line).value_or(1.0F);
            opacityIsGiven_ = true;
        } else if (keyword == "Tr" && !opacityIsGiven_) {
            material.opacity = 1.0F - firstNumber(line).value_or(0.0F);
        } else if (keyword == "illum") {
            material.illumination = static_cast<int>(std::clamp(firstNumber(line).value_or(2.0F), 0.0F, 10.0F));
        }
    }

    /// One or three numbers; `otherwise` with a warning where the file uses another notation.
    Rgb colour(const ObjLine& line, const Rgb& otherwise) {
        std::string_view rest = line.rest;
        std::string_view word = nextWord(rest);
        if (word == "spectral" || word == "xyz") {
            result_.warnings.push_back(fmt::format("material {}: {} {} is not supported, its default is used",
                                                   inQuotes(result_.materials.back().name), line.keyword, word));
            return otherwise;
        }
        std::vector<float> numbers;
        for (; !word.empty(); word = nextWord(rest)) {
            const auto number = parseFinite(word);
            if (!number) fail(line, word, fmt::format("a finite number after {}", line.keyword));
            numbers.push_back(*number);
        }
        if (numbers.size() == 1) return Rgb(numbers[0]);
        if (numbers.size() != 3) fail(line, line.text, fmt::format("1 or 3 numbers after {}", line.keyword));
        return {numbers[0], numbers[1], numbers[2]};
    }

    /// Only told apart from the diffuse part, so that anything is allowed.
    static Rgb specular(const ObjLine& line) {
        std::string_view rest = line.rest;
        Rgb result(0.0F);
        for (int channel = 0; channel < 3; ++channel) result[channel] = parseFinite(nextWord(rest)).value_or(0.0F);
        return result;
    }

    /// The first number, also of `d -halo 0.5`.
    static std::optional<float> firstNumber(const ObjLine& line) {
        std::string_view rest = line.rest;
        std::string_view word = nextWord(rest);
        if (word == "-halo") word = nextWord(rest);
        return parseFinite(word);
    }

    /// Options, then the file's name, which may have spaces; nothing if there is no name.
    std::optional<MtlMap> map(const ObjLine& line) const {
        MtlMap result;
        std::string_view rest = line.rest;
        while (true) {
            std::string_view after = rest;
            const std::string_view word = nextWord(after);
            const auto* option = std::find_if(kMapOptions.begin(), kMapOptions.end(),
                                              [&](const MapOption& known) { return known.name == word; });
            if (option == kMapOptions.end()) break;
            applyOption(line, *option, takeArguments(*option, after), result);
            rest = after;
        }
        rest.remove_prefix(std::min(rest.find_first_not_of(" \t\v\f"), rest.size()));
        result.file = rest;
        return result.file.empty() ? std::nullopt : std::optional(result);
    }

    void applyOption(const ObjLine& line, const MapOption& option, const std::vector<std::string_view>& words,
                     MtlMap& result) const {
        const auto number = [&](std::size_t k) {
            const auto value = parseFinite(k < words.size() ? words[k] : "");
            if (!value)
                fail(line, k < words.size() ? words[k] : line.text,
                     fmt::format("a finite number after {}", option.name));
            return *value;
        };
        if (option.name == "-s") {
            result.scale = {number(0), words.size() > 1 ? number(1) : 1.0F};
        } else if (option.name == "-o") {
            result.offset = {number(0), words.size() > 1 ? number(1) : 0.0F};
        } else if (option.name == "-mm") {
            result.base = number(0);
            result.gain = number(1);
        } else if (option.name == "-clamp") {
            result.clamp = !words.empty() && words[0] == "on";
        }
    }

    [[noreturn]] void fail(const ObjLine& line, std::string_view found, const std::string& expected) const {
        failAt(lines_.file(), line.number, found, expected);
    }

    ObjLines& lines_;
    MtlFile result_;
    bool opacityIsGiven_ = false; //!< the material at work has a `d`
};

} // namespace

MtlFile readMtl(ObjLines& lines) { return MtlReader(lines).run(); }

} // namespace lambert
