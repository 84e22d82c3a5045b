// STL is read here and not by a library because those of Debian 12 drop what is wanted: CGAL and OpenMesh the solids' names
// and degenerate facets, assimp binary files with bytes after the last facet.
#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"
#include "scene/words.h"

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

namespace lambert {

namespace {

constexpr std::size_t kHeaderBytes = 80, kFacetBytes = 50;
constexpr std::size_t kReportEvery = 1 << 16; // facets

/// What both kinds of file are made of.
class StlFacets {
public:
    StlFacets(const std::string& file, const ReadOptions& options)
        : builder_(file, options),
          metresPerUnit_(options.metresPerUnit),
          material_(builder_.addMaterial({.name = "default"})) {}

    SceneBuilder& builder() { return builder_; }

    /// What follows belongs to the solid `name`.
    void beginSolid(std::string_view name) { node_ = builder_.addNode(name.empty() ? "default" : asUtf8(name)); }

    std::size_t cornerCount() const { return corners_.size(); }
    void addVertex(const glm::dvec3& position) { corners_.push_back(builder_.addPosition(position * metresPerUnit_)); }

    /// Ends a facet with the vertices added.
    void endFacet() {
        if (node_ == kNone) beginSolid("");
        builder_.addPolygon(corners_, material_, node_);
        corners_.clear();
    }

private:
    SceneBuilder builder_;
    double metresPerUnit_;
    std::uint32_t material_;
    std::uint32_t node_ = kNone;
    std::vector<std::uint32_t> corners_;
};

std::uint32_t facetCount(std::string_view content) {
    std::uint32_t count = 0;
    std::memcpy(&count, content.data() + kHeaderBytes, sizeof count); // little-endian, as are our machines
    return count;
}

/// Binary files may begin with "solid" as well, but then hold zeros, or have just the size that their count asks for.
bool isText(std::string_view content) {
    constexpr std::size_t kBegin = kHeaderBytes + sizeof(std::uint32_t);
    if (content.size() >= kBegin && content.size() == kBegin + kFacetBytes * std::size_t{facetCount(content)})
        return false;
    const std::size_t word = content.find_first_not_of(" \t\r\n");
    if (word == std::string_view::npos) return false;
    return lowerCase(content.substr(word, 5)) == "solid" &&
           content.substr(0, 1024).find('\0') == std::string_view::npos;
}

void readBinary(const std::string& file, std::string_view content, const ReadOptions& options, StlFacets& facets) {
    constexpr std::size_t kBegin = kHeaderBytes + sizeof(std::uint32_t);
    if (content.size() < kBegin)
        throw InputError(
            fmt::format("{}: found {} bytes, expected \"solid\", or at least the {} bytes of a binary file's "
                        "header",
                        file, content.size(), kBegin));
    const std::size_t count = facetCount(content);
    const std::size_t present = (content.size() - kBegin) / kFacetBytes;
    if (count > present)
        throw InputError(
            fmt::format("{}: byte {}: found {} as the number of facets, expected at most {}, what the file "
                        "has room for",
                        file, kHeaderBytes, count, present));
    if (const std::size_t used = kBegin + count * kFacetBytes; used < content.size())
        facets.builder().warn(fmt::format("{} bytes after the last facet were ignored", content.size() - used));

    options.progress->begin("read facets", count);
    for (std::size_t k = 0; k < count; ++k) {
        std::array<float, 12> numbers; // the normal, which is not used, and three vertices
        std::memcpy(numbers.data(), content.data() + kBegin + k * kFacetBytes, sizeof numbers);
        for (std::size_t v = 3; v < 12; v += 3) {
            const glm::vec3 vertex(numbers[v], numbers[v + 1], numbers[v + 2]);
            facets.builder().noteSinglePrecision(vertex, options.metresPerUnit);
            facets.addVertex(glm::dvec3(vertex));
        }
        facets.endFacet();
        if ((k + 1) % kReportEvery == 0) options.progress->advance(kReportEvery);
    }
    options.progress->end();
}

/// Takes the statements of a text file, each a line, to its facets.
class TextReading {
public:
    TextReading(const std::string& file, std::string_view content, StlFacets& facets)
        : file_(file), rest_(content), facets_(facets) {}

    void run() {
        while (!rest_.empty()) {
            nextLine();
            if (!line_.empty()) statement();
        }
        if (inFacet_) failAt(file_, number_, "the end of the file", "endfacet");
        if (inSolid_) facets_.builder().warn("the file ends without endsolid");
    }

private:
    void nextLine() {
        const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
        line_ = trimmed(rest_.substr(0, end));
        rest_.remove_prefix(end);
        rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : std::min<std::size_t>(rest_.size(), 1));
        ++number_;
    }

    void statement() {
        std::string_view rest = line_;
        const std::string keyword = lowerCase(nextWord(rest));
        if (keyword == "vertex") {
            addVertex(rest);
        } else if (keyword == "facet" || keyword == "endfacet") {
            const bool begins = keyword == "facet";
            if (inFacet_ == begins) fail(begins ? "endfacet before it" : "facet before it");
            inFacet_ = begins;
            if (!begins) facets_.endFacet();
        } else if (keyword == "solid" || keyword == "endsolid") {
            if (inFacet_) fail("endfacet before it");
            inSolid_ = keyword == "solid";
            if (inSolid_) facets_.beginSolid(trimmed(rest));
        } else if (keyword != "outer" && keyword != "endloop") {
            fail("solid, facet, outer loop, vertex, endloop, endfacet or endsolid");
        }
    }

    void addVertex(std::string_view words) {
        if (!inFacet_) fail("facet before it");
        if (facets_.cornerCount() == kMostPolygonCorners) fail(fmt::format("at most {} vertices", kMostPolygonCorners));
        glm::dvec3 position;
        for (int axis = 0; axis < 3; ++axis) {
            const std::optional<double> value = parseNumber(nextWord(words));
            if (!value) fail("3 numbers after vertex");
            position[axis] = *value;
        }
        facets_.addVertex(position);
    }

    [[noreturn]] void fail(const std::string& expected) const { failAt(file_, number_, line_, expected); }

    const std::string& file_;
    std::string_view rest_, line_;
    std::size_t number_ = 0; //!< of the line, from 1
    StlFacets& facets_;
    bool inSolid_ = false, inFacet_ = false;
};

} // namespace

ReadResult readStl(const std::filesystem::path& path, const ReadOptions& options) {
    const std::string file = path.string();
    const std::string content = readInputFile(path);
    StlFacets facets(file, options);
    if (isText(content)) {
        TextReading(file, content, facets).run();
    } else {
        readBinary(file, content, options, facets);
    }
    return facets.builder().finish();
}

} // namespace lambert
