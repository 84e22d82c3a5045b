#include "scene/ply/surface.h"
#include "picture/srgb.h"

#include <fmt/format.h>

#include <algorithm>

namespace lambert {

PlyTints::PlyTints(const PlyElement& element) {
    const std::array columns{element.findNumber({"red", "diffuse_red", "r"}),
                             element.findNumber({"green", "diffuse_green", "g"}),
                             element.findNumber({"blue", "diffuse_blue", "b"})};
    for (std::size_t c = 0; c < 3; ++c) {
        if (!columns[c]) return;
        columns_[c] = *columns[c];
        const PlyType type = element.properties[columns_[c]].type;
        if (isInteger(type)) largest_[c] = type == PlyType::Uint16 ? 65535.0 : 255.0;
    }
    present_ = true;
}

Rgb PlyTints::read(const PlyRecords& record) {
    Rgb tint;
    bool clamped = false;
    for (std::size_t c = 0; c < 3; ++c) {
        const double value = record.number(columns_[c]);
        const auto linear =
            static_cast<float>(largest_[c] > 0.0 ? srgbDecoded(std::clamp(value / largest_[c], 0.0, 1.0)) : value);
        const bool allowed = linear >= 0.0F && linear <= kMaxReflectance; // false if it is not a number
        tint[static_cast<int>(c)] = allowed ? linear / kMaxReflectance : (linear > 0.0F ? 1.0F : 0.0F);
        clamped |= !allowed;
    }
    if (clamped) ++clamped_;
    return tint;
}

PlyFaceSurface::PlyFaceSurface(const PlyElement& face, const PlyVertexSurface& vertices, std::size_t images)
    : vertices_(vertices),
      images_(images),
      tints_(face),
      coordinates_(face.findList({"texcoord"})),
      imageNumber_(face.findNumber({"texnumber"})) {}

void PlyFaceSurface::read(const PlyRecords& face, std::span<const std::uint32_t> corners) {
    corners_.assign(hasTints() ? corners.size() : 0, {});
    if (tints_.present()) {
        const Rgb tint = tints_.read(face);
        for (auto& corner : corners_) corner.tint = tint;
    } else if (hasTints()) {
        for (std::size_t k = 0; k < corners.size(); ++k) corners_[k].tint = vertices_.tints[corners[k]];
    }
    image_ = kNone;
    if (images_ > 0 && hasCoordinates()) readCoordinates(face, corners);
}

void PlyFaceSurface::readCoordinates(const PlyRecords& face, std::span<const std::uint32_t> corners) {
    const double image = imageNumber_ ? face.number(*imageNumber_) : 0.0;
    if (image == -1.0) return; // as MeshLab writes a face without an image
    if (!(image >= 0.0 && image < static_cast<double>(images_)))
        face.fail(fmt::format("the image {:g}", image), fmt::format("-1 to {}", images_ - 1));
    if (coordinates_) {
        const std::vector<double>& list = face.list(*coordinates_);
        if (list.empty()) return;
        if (list.size() != 2 * corners.size())
            face.fail(fmt::format("{} texture coordinates", list.size()), std::to_string(2 * corners.size()));
        corners_.resize(corners.size());
        for (std::size_t k = 0; k < corners.size(); ++k)
            corners_[k].uv = plyTextureCoordinates(list[2 * k], list[2 * k + 1]);
    } else {
        corners_.resize(corners.size());
        for (std::size_t k = 0; k < corners.size(); ++k) corners_[k].uv = vertices_.coordinates[corners[k]];
    }
    image_ = static_cast<std::uint32_t>(image);
}

} // namespace lambert
