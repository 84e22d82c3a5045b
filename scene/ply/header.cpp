#include "scene/ply/header.h"

#include "core/error.h"
#include "scene/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace lambert {

namespace {

constexpr std::size_t kMostLines = 10000; // so that a hostile header cannot be larger than the data it describes

/// The older and the newer names of the eight PlyTypes.
constexpr std::array<std::string_view, 16> kTypes{"char",  "uchar",  "short",   "ushort", "int",   "uint",
                                                  "float", "double", "int8",    "uint8",  "int16", "uint16",
                                                  "int32", "uint32", "float32", "float64"};

std::optional<std::size_t> findProperty(const std::vector<PlyProperty>& properties,
                                        std::initializer_list<std::string_view> names, bool isList) {
    for (const std::string_view name : names)
        for (std::size_t k = 0; k < properties.size(); ++k)
            if (properties[k].name == name && properties[k].countType.has_value() == isList) return k;
    return std::nullopt;
}

class HeaderParser {
public:
    HeaderParser(const std::string& file, std::string_view content) : file_(file), rest_(content) {}

    PlyHeader run() {
        const std::size_t whole = rest_.size();
        // A carriage return alone ends lines only if it ends the first one: binary data may begin with a line feed.
        const std::size_t firstEnd = rest_.find_first_of("\r\n");
        if (firstEnd != std::string_view::npos && rest_[firstEnd] == '\r' &&
            !rest_.substr(firstEnd).starts_with("\r\n"))
            lineEnd_ = '\r';
        nextLine();
        if (words_ != std::vector<std::string_view>{"ply"}) fail("ply, the first line of a PLY file");
        do {
            nextLine();
        } while (statement());
        if (!hasFormat_) fail("a line \"format\" before it");
        header_.bytes = whole - rest_.size();
        checkCounts();
        return std::move(header_);
    }

private:
    void nextLine() {
        if (rest_.empty() || header_.lines == kMostLines)
            throw InputError(fmt::format("{}: found no end_header in the first {} lines", file_, header_.lines));
        const std::size_t end = rest_.find(lineEnd_);
        line_ = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        ++header_.lines;
        words_ = wordsOf(line_);
    }

    /// False at the end of the header.
    bool statement() {
        if (words_.empty()) return true;
        const std::string_view keyword = words_[0];
        if (keyword == "end_header") return false;
        if (keyword == "comment") {
            comment();
        } else if (keyword == "format") {
            format();
        } else if (keyword == "element") {
            element();
        } else if (keyword == "property") {
            property();
        } else if (keyword != "obj_info") {
            fail("format, element, property, comment, obj_info or end_header");
        }
        return true;
    }

    void comment() {
        if (words_.size() < 3 || words_[1] != "TextureFile") return;
        // The name is all the rest: it may have spaces.
        const char* const begin = words_[2].data();
        const char* const end = words_.back().data() + words_.back().size();
        header_.textureFiles.emplace_back(begin, end);
    }

    void format() {
        constexpr std::array<std::string_view, 3> kNames{"ascii", "binary_little_endian", "binary_big_endian"};
        const auto known = words_.size() < 2 ? kNames.end() : std::find(kNames.begin(), kNames.end(), words_[1]);
        if (known == kNames.end()) fail("format ascii, binary_little_endian or binary_big_endian");
        header_.format = static_cast<PlyFormat>(known - kNames.begin());
        hasFormat_ = true;
    }

    void element() {
        if (words_.size() != 3) fail("element NAME COUNT");
        PlyElement result{std::string(words_[1]), 0, {}, header_.lines};
        const std::string_view count = words_[2];
        const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), result.count);
        if (error != std::errc() || end != count.data() + count.size()) fail("element NAME COUNT");
        if (header_.element(result.name) != nullptr) fail("each element only once");
        header_.elements.push_back(std::move(result));
    }

    void property() {
        const bool isList = words_.size() > 1 && words_[1] == "list";
        if (words_.size() != (isList ? 5U : 3U)) fail("property TYPE NAME, or property list TYPE TYPE NAME");
        if (header_.elements.empty()) fail("an element before it");
        PlyProperty result{std::string(words_.back()), type(words_[words_.size() - 2]), {}};
        if (isList) {
            result.countType = type(words_[2]);
            if (!isInteger(*result.countType)) fail("an integer type for the length of a list");
        }
        header_.elements.back().properties.push_back(std::move(result));
    }

    PlyType type(std::string_view name) const {
        const auto known = std::find(kTypes.begin(), kTypes.end(), name);
        if (known == kTypes.end())
            fail("a type: char, uchar, short, ushort, int, uint, float, double, or int8 to float64");
        return static_cast<PlyType>((known - kTypes.begin()) % 8);
    }

    /// Before anything is allocated for the records.
    void checkCounts() const {
        // In text a number takes a digit and a space, but for the last.
        std::uint64_t available = rest_.size() + (header_.format == PlyFormat::Ascii ? 1 : 0);
        for (const PlyElement& element : header_.elements) {
            std::uint64_t least = 0;
            for (const PlyProperty& property : element.properties)
                least +=
                    header_.format == PlyFormat::Ascii ? 2 : sizeInBytes(property.countType.value_or(property.type));
            if (least == 0) continue;
            if (element.count > available / least)
                failAt(file_, element.line, fmt::format("element {} {}", element.name, element.count),
                       fmt::format("at most {}: no more fit into the file", available / least));
            available -= element.count * least;
        }
    }

    [[noreturn]] void fail(const std::string& expected) const { failAt(file_, header_.lines, line_, expected); }

    const std::string& file_;
    std::string_view rest_, line_;
    std::vector<std::string_view> words_;
    char lineEnd_ = '\n';
    bool hasFormat_ = false;
    PlyHeader header_;
};

} // namespace

std::size_t sizeInBytes(PlyType type) {
    constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

std::optional<std::size_t> PlyElement::findNumber(std::initializer_list<std::string_view> names) const {
    return findProperty(properties, names, false);
}

std::optional<std::size_t> PlyElement::findList(std::initializer_list<std::string_view> names) const {
    return findProperty(properties, names, true);
}

const PlyElement* PlyHeader::element(std::string_view name) const {
    const auto found = std::find_if(elements.begin(), elements.end(), [&](const auto& e) { return e.name == name; });
    return found == elements.end() ? nullptr : &*found;
}

PlyHeader parsePlyHeader(const std::string& file, std::string_view content) {
    return HeaderParser(file, content).run();
}

} // namespace lambert
