#include "core/error.h"
#include "core/text.h"
#include "scene/obj/lines.h"
#include "scene/obj/material.h"
#include "scene/obj/vertices.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"
#include "scene/words.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <vector>

namespace lambert {

namespace {

/// What references count, for messages.
struct Numbered {
    const char *one, *many;
};
constexpr Numbered kVertex{"vertex", "vertices"};
constexpr Numbered kTextureCoordinate{"texture coordinate", "texture coordinates"};

/// Goes through the file a second time and adds its faces.
class FaceReader {
public:
    FaceReader(ObjLines& lines, const ObjVertices& vertices, ObjMaterials& materials, SceneBuilder& builder)
        : lines_(lines), vertices_(vertices), materials_(materials), builder_(builder) {}

    void run() {
        while (const auto line = lines_.next()) readStatement(*line);
        if (withoutUv_ > 0)
            builder_.warn(fmt::format("{} polygons of materials with an image have no texture coordinates: 0 0 is used",
                                      withoutUv_));
    }

private:
    void readStatement(const ObjLine& line) {
        const std::string_view keyword = line.keyword;
        if (keyword == "f" || keyword == "fo") {
            readFace(line);
        } else if (keyword == "v") {
            ++positionsBefore_;
        } else if (keyword == "vt") {
            ++uvBefore_;
        } else if (keyword == "g" || keyword == "o") {
            nodeName_ = line.rest.empty() ? "default" : asUtf8(line.rest);
            nodeIsKnown_ = false;
        } else if (keyword == "usemtl") {
            materialName_ = line.rest.empty() ? kNoMaterial : asUtf8(line.rest);
            material_ = nullptr;
        }
    }

    void readFace(const ObjLine& line) {
        // Materials and nodes without a face do not count.
        if (!material_) material_ = &materials_.find(materialName_);
        if (!nodeIsKnown_) node_ = nodeIndex();

        corners_.clear();
        surface_.clear();
        const bool varies = material_->textured || material_->tinted;
        bool hasUv = true;
        std::string_view rest = line.rest;
        for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest)) {
            const Reference reference = parseReference(word, line.number);
            corners_.push_back(reference.position);
            if (corners_.size() > kMostPolygonCorners)
                failAt(lines_.file(), line.number, line.text,
                       fmt::format("at most {} vertices after f", kMostPolygonCorners));
            if (varies) {
                surface_.push_back(cornerSurface(reference, word, line.number));
                hasUv = hasUv && reference.uv != 0;
            }
        }
        if (corners_.size() < 3) failAt(lines_.file(), line.number, line.text, "at least 3 vertices after f");
        if (material_->textured && !hasUv) ++withoutUv_;
        builder_.addPolygon(corners_, material_->index, node_, surface_);
    }

    struct Reference {
        std::uint32_t position; //!< SceneBuilder's
        long long uv;           //!< as written; 0: none
    };

    /// Checks v, v/vt, v//vn or v/vt/vn.
    Reference parseReference(std::string_view reference, std::size_t line) const {
        const char* next = reference.data();
        const char* const end = next + reference.size();
        std::array<long long, 3> indices{};
        for (std::size_t part = 0;; ++part) {
            const auto [stop, error] = std::from_chars(next, end, indices[part]);
            const bool isIndex = error == std::errc{} && indices[part] != 0;
            const bool leftOut = part > 0 && (next == end || *next == '/');
            if (!isIndex && !leftOut) failAtReference(reference, line);
            next = stop;
            if (next == end) break;
            if (*next != '/' || part == 2) failAtReference(reference, line);
            ++next;
        }
        return {static_cast<std::uint32_t>(
                    resolve(indices[0], positionsBefore_, vertices_.positions, kVertex, reference, line)),
                indices[1]};
    }

    SceneBuilder::CornerSurface cornerSurface(const Reference& corner, std::string_view reference,
                                              std::size_t line) const {
        SceneBuilder::CornerSurface result;
        if (material_->tinted) result.tint = vertices_.tints[corner.position];
        if (material_->textured && corner.uv != 0) {
            const std::size_t index =
                resolve(corner.uv, uvBefore_, vertices_.uv.size(), kTextureCoordinate, reference, line);
            result.uv = material_->uv(vertices_.uv[index]);
            result.emissionUv = material_->emissionUv(vertices_.uv[index]);
        }
        return result;
    }

    /// An index counted from 1, or back from this line, as one counted from 0.
    std::size_t resolve(long long index, std::size_t before, std::size_t all, const Numbered& what,
                        std::string_view reference, std::size_t line) const {
        if (index > 0) {
            if (std::cmp_greater(index, all))
                failAt(lines_.file(), line, reference, fmt::format("a {} that exists: the file has {}", what.one, all));
            return static_cast<std::size_t>(index - 1);
        }
        const auto count = static_cast<long long>(before);
        if (index < -count)
            failAt(lines_.file(), line, reference,
                   fmt::format("a {} that exists: {} {} lie before this line", what.one, before, what.many));
        return static_cast<std::size_t>(count + index);
    }

    [[noreturn]] void failAtReference(std::string_view reference, std::size_t line) const {
        failAt(lines_.file(), line, reference, "a reference v, v/vt, v//vn or v/vt/vn of integers other than 0");
    }

    std::uint32_t nodeIndex() {
        nodeIsKnown_ = true;
        const auto [entry, isNew] = nodes_.try_emplace(nodeName_, 0);
        if (isNew) entry->second = builder_.addNode(nodeName_);
        return entry->second;
    }

    ObjLines& lines_;
    const ObjVertices& vertices_;
    ObjMaterials& materials_;
    SceneBuilder& builder_;

    std::size_t positionsBefore_ = 0;
    std::size_t uvBefore_ = 0;
    std::string materialName_ = kNoMaterial;
    const ObjMaterial* material_ = nullptr; //!< of materialName_, once a face has it
    std::string nodeName_ = "default";
    std::uint32_t node_ = 0;
    bool nodeIsKnown_ = false;
    std::unordered_map<std::string, std::uint32_t> nodes_;
    std::size_t withoutUv_ = 0;
    // Of the face at work:
    std::vector<std::uint32_t> corners_;
    std::vector<SceneBuilder::CornerSurface> surface_;
};

void warnOfIgnored(const ObjVertices& file, SceneBuilder& builder) {
    std::string ignored;
    if (file.pointsAndLines > 0) ignored = fmt::format("{} points or lines", file.pointsAndLines);
    if (file.curvesAndSurfaces > 0)
        ignored += fmt::format("{}{} curves or surfaces", ignored.empty() ? "" : " and ", file.curvesAndSurfaces);
    if (!ignored.empty()) builder.warn(ignored + " were ignored");
}

} // namespace

ReadResult readObj(const std::filesystem::path& path, const ReadOptions& options) {
    std::error_code missing; // opening it will tell
    const auto size = std::filesystem::file_size(path, missing);
    options.progress->begin("read", missing ? 0 : size);
    auto countBytes = [&, gone = std::uint64_t{0}](std::uint64_t bytes) mutable {
        options.progress->advance((gone + bytes) / 2 - gone / 2);
        gone += bytes;
    };
    SceneBuilder builder(path.string(), options);

    ObjLines first(path, std::ref(countBytes));
    const ObjVertices vertices = readObjVertices(first, options.metresPerUnit, builder);
    builder.reserve(vertices.positions, vertices.faces);

    ObjMaterials materials(builder, options, path.parent_path(), !vertices.tints.empty());
    for (const std::string& library : vertices.libraries) materials.addLibraries(library);

    ObjLines second(path, std::ref(countBytes));
    FaceReader(second, vertices, materials, builder).run();
    materials.warnOfReplacements();
    warnOfIgnored(vertices, builder);
    options.progress->end();
    return builder.finish();
}

} // namespace lambert
