// PLY is read here and not by a library because none of Debian 12 reads it whole: OpenMesh cuts colours to 8 bits and
// loses its place at lists, CGAL's functions know no colours but bytes, assimp none of faces, Draco no big-endian files.
#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "scene/ply/surface.h"
#include "scene/readers.h"
#include "scene/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace lambert {

namespace {

constexpr std::uint64_t kReportEvery = 1 << 16; // records

/// The materials of a file: `default`, or one for each of several images.
class Materials {
public:
    Materials(SceneBuilder& builder, std::filesystem::path folder, const PlyHeader& header)
        : builder_(builder), folder_(std::move(folder)), files_(header.textureFiles) {}

    /// Of faces with this image (kNone: without one) and with tints or without.
    std::uint32_t index(std::uint32_t image, bool tinted) {
        const auto [entry, isNew] = indices_.try_emplace(image, 0);
        if (!isNew) return entry->second;
        Material material;
        material.name = files_.size() > 1 && image != kNone ? asUtf8(files_[image]) : "default";
        if (image != kNone)
            material.reflectanceTexture.texture = builder_.addTextureFile(
                folder_, files_[image], TextureContent::Colour, "the constant reflectance is used");
        if (tinted || material.reflectanceTexture) material.reflectance = Rgb(kMaxReflectance);
        return entry->second = builder_.addMaterial(std::move(material));
    }

private:
    SceneBuilder& builder_;
    std::filesystem::path folder_;
    const std::vector<std::string>& files_;
    std::map<std::uint32_t, std::uint32_t> indices_;
};

class PlyReading {
public:
    PlyReading(const std::filesystem::path& path, const ReadOptions& options)
        : file_(path.string()),
          folder_(path.parent_path()),
          options_(options),
          content_(readInputFile(path)),
          header_(parsePlyHeader(file_, content_)),
          builder_(file_, options) {}

    ReadResult run() {
        const PlyElement* const vertices = header_.element("vertex");
        const PlyElement* const faces = header_.element("face");
        if (!faces || faces->count == 0)
            throw InputError(fmt::format("{}: found {} vertices and no faces, expected faces: points have no surface{}",
                                         file_, vertices ? vertices->count : 0,
                                         header_.element("tristrips") ? ", and triangle strips are not read" : ""));
        if (!vertices || vertices->count == 0)
            throw InputError(fmt::format("{}: found {} faces and no vertices", file_, faces->count));

        PlyRecords records(file_, content_, header_);
        std::optional<PlyRecords> atFaces; // they may come before the vertices
        for (const PlyElement& element : header_.elements) {
            if (&element == faces) atFaces = records;
            if (atFaces && vertexCount_ > 0) break;
            if (&element == vertices) {
                readVertices(records, element);
            } else {
                records.skip(element);
            }
        }
        readFaces(*atFaces, *faces);
        if (clampedColours_ > 0)
            builder_.warn(fmt::format("{} colours were clamped to 0 ... {}", clampedColours_, kMaxReflectance));
        return builder_.finish();
    }

private:
    void readVertices(PlyRecords& records, const PlyElement& element) {
        const auto x = element.findNumber({"x"}), y = element.findNumber({"y"}), z = element.findNumber({"z"});
        if (!x || !y || !z) failAt(file_, element.line, "element vertex", "its properties x, y and z");
        const auto u = element.findNumber({"s", "u", "texture_u"}), v = element.findNumber({"t", "v", "texture_v"});
        const bool hasCoordinates = !header_.textureFiles.empty() && u && v;
        const bool isSingle = std::ranges::any_of(
            std::array{*x, *y, *z}, [&](std::size_t k) { return element.properties[k].type == PlyType::Float32; });
        PlyTints tints(element);
        if (tints.present() && element.findNumber({"radiosity_r"}))
            builder_.warn("holds baked light: its colours are read as reflectance, and no emission");
        forRecords(records, element, [&] {
            const glm::dvec3 position(records.number(*x), records.number(*y), records.number(*z));
            if (isSingle) builder_.noteSinglePrecision(glm::vec3(position), options_.metresPerUnit);
            builder_.addPosition(position * options_.metresPerUnit);
            if (tints.present()) vertices_.tints.push_back(tints.read(records));
            if (hasCoordinates)
                vertices_.coordinates.push_back(plyTextureCoordinates(records.number(*u), records.number(*v)));
        });
        vertexCount_ = element.count;
        clampedColours_ += tints.clampedCount();
    }

    void readFaces(PlyRecords& records, const PlyElement& element) {
        const auto indices = element.findList({"vertex_indices", "vertex_index"});
        if (!indices) failAt(file_, element.line, "element face", "its list vertex_indices or vertex_index");
        PlyFaceSurface surface(element, vertices_, header_.textureFiles.size());
        if (!header_.textureFiles.empty() && !surface.hasCoordinates())
            builder_.warn("images without texture coordinates were ignored");
        Materials materials(builder_, folder_, header_);
        const std::uint32_t node = builder_.addNode("default");
        std::vector<std::uint32_t> corners;
        forRecords(records, element, [&] {
            const std::vector<double>& list = records.list(*indices);
            if (list.size() > kMostPolygonCorners)
                records.fail(fmt::format("{} vertices", list.size()), fmt::format("at most {}", kMostPolygonCorners));
            corners.clear();
            for (const double index : list) {
                if (!(index >= 0.0 && index < static_cast<double>(vertexCount_)) || index != std::floor(index))
                    records.fail(fmt::format("the vertex {}", index), fmt::format("0 to {}", vertexCount_ - 1));
                corners.push_back(static_cast<std::uint32_t>(index));
            }
            surface.read(records, corners);
            builder_.addPolygon(corners, materials.index(surface.image(), surface.hasTints()), node, surface.corners());
        });
        clampedColours_ += surface.clampedCount();
    }

    template <typename Use>
    void forRecords(PlyRecords& records, const PlyElement& element, Use&& use) {
        options_.progress->begin("read " + element.name, element.count);
        for (std::uint64_t k = 0; k < element.count; ++k) {
            records.read(element, k);
            use();
            if ((k + 1) % kReportEvery == 0) options_.progress->advance(kReportEvery);
        }
        options_.progress->end();
    }

    std::string file_;
    std::filesystem::path folder_;
    const ReadOptions& options_;
    std::string content_;
    PlyHeader header_;
    SceneBuilder builder_;

    std::uint64_t vertexCount_ = 0; //!< of vertices read
    PlyVertexSurface vertices_;
    std::size_t clampedColours_ = 0;
};

} // namespace

ReadResult readPly(const std::filesystem::path& path, const ReadOptions& options) {
    return PlyReading(path, options).run();
}

} // namespace lambert
