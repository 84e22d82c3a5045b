#include "scene/obj_syntax.h"

#include "scene/input_file.h"
#include "scene/obj_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <unordered_map>

namespace lambert {

namespace {

constexpr std::size_t kWidestOfTinyObj = 255; // it counts a face's vertices in an unsigned char

class ObjChecker {
public:
    explicit ObjChecker(const std::string& file) : file_(file) {}

    ObjText run(std::string_view text) {
        ObjLines lines(text);
        while (const auto line = lines.next()) check(*line);
        checkForwardReferences();
        return std::move(result_);
    }

private:
    /// A positive index that the file had not reached yet.
    struct ForwardReference {
        long long index;
        std::size_t line;
    };

    void check(const ObjLine& line) {
        if (line.keyword == "v") {
            checkNumbers(line, 3, true);
            ++vertices_;
        } else if (line.keyword == "vn") {
            checkNumbers(line, 3, false);
        } else if (line.keyword == "vt") {
            checkNumbers(line, 1, false);
        } else if (line.keyword == "f") {
            checkFace(line);
        } else if (line.keyword == "g" || line.keyword == "o") {
            writeName("g", line.rest.empty() ? "default" : line.rest, groupNumbers_, result_.groups);
        } else if (line.keyword == "usemtl") {
            writeName("usemtl", line.rest.empty() ? "default" : line.rest, materialNumbers_, result_.materials);
        } else if (line.keyword == "mtllib") {
            if (!line.rest.empty()) result_.libraries.emplace_back(line.rest);
        } else if (line.keyword == "p" || line.keyword == "l") {
            ++result_.ignoredElements;
        }
    }

    void checkNumbers(const ObjLine& line, int count, bool write) {
        if (write) result_.statements += 'v';
        std::string_view rest = line.rest;
        for (int k = 0; k < count; ++k) {
            const std::string_view word = nextWord(rest);
            const auto number = parseNumber(word);
            if (!number)
                failAt(file_, line.number, word.empty() ? line.text : word,
                       fmt::format("{} number{} after {}", count, count > 1 ? "s" : "", line.keyword));
            if (!write) continue;
            result_.statements += ' ';
            // tinyobjloader reads "nan" as 0, but an exponent this large as infinity
            result_.statements += std::isfinite(*number) ? word : "1e999";
        }
        if (write) result_.statements += '\n';
    }

    void checkFace(const ObjLine& line) {
        result_.statements += 'f';
        std::string_view rest = line.rest;
        std::size_t corners = 0;
        for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest), ++corners)
            fmt::format_to(std::back_inserter(result_.statements), " {}", vertexIndex(word, line.number));
        if (corners < 3) failAt(file_, line.number, line.text, "at least 3 vertices after f");
        if (corners > kWidestOfTinyObj) result_.wideFaces.emplace(faces_, corners);
        result_.statements += '\n';
        ++faces_;
    }

    /// Checks v, v/vt, v//vn or v/vt/vn, and returns the vertex, counted from 1.
    long long vertexIndex(std::string_view reference, std::size_t line) {
        std::string_view rest = reference;
        long long vertex = 0;
        for (int part = 0;; ++part) {
            const std::size_t slash = rest.find('/');
            const std::string_view digits = rest.substr(0, slash);
            long long index = 0;
            const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
            const bool isIndex = error == std::errc{} && end == digits.data() + digits.size() && index != 0;
            const bool leftOut = part > 0 && digits.empty();
            if (part > 2 || !(isIndex || leftOut))
                failAt(file_, line, reference, "a reference v, v/vt, v//vn or v/vt/vn of integers other than 0");
            if (part == 0) vertex = index;
            if (slash == std::string_view::npos) break;
            rest.remove_prefix(slash + 1);
        }
        if (vertex < 0) {
            if (vertex < -vertices_)
                failAt(file_, line, reference,
                       fmt::format("a vertex that exists: {} vertices lie before this line", vertices_));
            return vertices_ + vertex + 1;
        }
        // Only a larger one than all before can turn out to be the first that is too large.
        if (vertex > vertices_ && (forward_.empty() || vertex > forward_.back().index))
            forward_.push_back({vertex, line});
        return vertex;
    }

    void checkForwardReferences() const {
        for (const ForwardReference& reference : forward_)
            if (reference.index > vertices_)
                failAt(file_, reference.line, std::to_string(reference.index),
                       fmt::format("a vertex that exists: the file has {}", vertices_));
    }

    void writeName(const char* keyword, std::string_view name, std::unordered_map<std::string, std::size_t>& numbers,
                   std::vector<std::string>& names) {
        const auto [entry, isNew] = numbers.try_emplace(std::string(name), names.size());
        if (isNew) names.emplace_back(name);
        fmt::format_to(std::back_inserter(result_.statements), "{} {}\n", keyword, entry->second);
    }

    const std::string& file_;
    ObjText result_;
    long long vertices_ = 0;
    std::size_t faces_ = 0;
    std::vector<ForwardReference> forward_;
    std::unordered_map<std::string, std::size_t> groupNumbers_, materialNumbers_;
};

class MtlChecker {
public:
    explicit MtlChecker(const std::string& file) : file_(file) {}

    MtlText run(std::string_view text) {
        ObjLines lines(text);
        while (const auto line = lines.next()) check(*line);
        finishMaterial();
        return std::move(result_);
    }

private:
    void check(const ObjLine& line) {
        if (line.keyword == "newmtl") {
            finishMaterial();
            if (line.rest.empty()) failAt(file_, line.number, line.text, "a name after newmtl");
            name_ = line.rest;
            result_.statements += fmt::format("newmtl {}\n", name_);
        } else if (line.keyword == "Kd" || line.keyword == "Ke") {
            if (name_.empty()) failAt(file_, line.number, line.text, "newmtl NAME before it");
            checkColour(line);
            (line.keyword == "Kd" ? hasKd_ : hasKe_) = true;
        } else if (line.keyword == "map_Kd" || line.keyword == "map_Ke") {
            (line.keyword == "map_Kd" ? hasMapKd_ : hasMapKe_) = true;
        } else {
            noteBeyondDiffuse(line);
        }
    }

    /// What is not read but worth telling. Numbers that make no sense are not looked at.
    void noteBeyondDiffuse(const ObjLine& line) {
        std::string_view rest = line.rest;
        const double value = parseNumber(nextWord(rest)).value_or(0.0);
        if (line.keyword == "illum")
            beyondDiffuse_ |= value >= 3.0 && value <= 9.0 && value != 8.0; // 8: shadows only
        else if (line.keyword == "Ks")
            for (std::string_view word = line.rest, one = nextWord(word); !one.empty(); one = nextWord(word))
                specular_ = std::max(specular_, parseNumber(one).value_or(0.0));
    }

    void checkColour(const ObjLine& line) {
        std::string_view rest = line.rest;
        std::string_view word = nextWord(rest);
        if (word == "spectral" || word == "xyz") {
            warn(fmt::format("{} {} is not supported, its default is used", line.keyword, word));
            writeColour(line.keyword, line.keyword == "Kd" ? "0.5" : "0");
            return;
        }
        std::vector<std::string_view> numbers;
        for (; !word.empty(); word = nextWord(rest)) {
            const auto number = parseNumber(word);
            if (!number || !(std::abs(*number) <= double{std::numeric_limits<float>::max()}))
                failAt(file_, line.number, word, fmt::format("a finite number after {}", line.keyword));
            numbers.push_back(word);
            if (line.keyword == "Kd") diffuse_ = std::max(diffuse_, *number);
        }
        if (numbers.size() == 1) {
            writeColour(line.keyword, numbers[0]);
        } else if (numbers.size() == 3) {
            result_.statements += fmt::format("{} {} {} {}\n", line.keyword, numbers[0], numbers[1], numbers[2]);
        } else {
            failAt(file_, line.number, line.text, fmt::format("1 or 3 numbers after {}", line.keyword));
        }
    }

    void writeColour(std::string_view keyword, std::string_view grey) {
        result_.statements += fmt::format("{0} {1} {1} {1}\n", keyword, grey);
    }

    void finishMaterial() {
        if (!name_.empty()) {
            if (hasMapKd_) warn("the texture map_Kd is not read, Kd is used");
            if (hasMapKe_) warn("the texture map_Ke is not read, Ke is used");
            if (!hasKd_ && hasMapKd_) {
                writeColour("Kd", "0.5");
            } else if (!hasKd_ && !hasKe_) {
                warn("has no Kd: its reflectance is 0");
            }
            if (beyondDiffuse_ || specular_ > diffuse_) result_.diffusePartOnly.insert(name_);
        }
        beyondDiffuse_ = false;
        diffuse_ = specular_ = 0.0;
        hasKd_ = hasKe_ = hasMapKd_ = hasMapKe_ = false;
    }

    void warn(const std::string& text) {
        result_.warnings.push_back(fmt::format("material {}: {}", inQuotes(name_), text));
    }

    const std::string& file_;
    MtlText result_;
    std::string name_; //!< of the material at work; empty before the first
    bool hasKd_ = false, hasKe_ = false, hasMapKd_ = false, hasMapKe_ = false;
    bool beyondDiffuse_ = false;
    double diffuse_ = 0.0, specular_ = 0.0; //!< the largest channel
};

} // namespace

ObjText checkObj(const std::string& file, std::string_view text) { return ObjChecker(file).run(text); }

MtlText checkMtl(const std::string& file, std::string_view text) { return MtlChecker(file).run(text); }

} // namespace lambert
