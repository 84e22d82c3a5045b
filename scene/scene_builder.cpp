#include "scene/scene_builder.h"

#include "core/error.h"
#include "core/text.h"
#include "core/triangulation.h"
#include "scene/merge_warnings.h"
#include "scene/named_file.h"
#include "scene/polygon_shape.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lambert {

namespace {

constexpr float kMaxEmission = 1e30F; // far above it, π L_e would not be finite
constexpr std::uintmax_t kPolygonsOfAnyFile = 1U << 20;
constexpr std::size_t kMostFanCorners = 256;
// Metres: each of 10^8 patches has an area in single precision, with much to spare.
constexpr float kSmallestScene = 1e-10F;
constexpr double kCoarse = 1e-5;      // of the diagonal: coarser coordinates open gaps that light finds
constexpr double kMaxOffPlane = 1e-5; // of a quad's longest diagonal

SceneBuilder::CornerSurface finite(SceneBuilder::CornerSurface corner) {
    const auto clean = [](float value) { return std::isfinite(value) ? value : 0.0F; };
    for (int k = 0; k < 2; ++k) {
        corner.uv[k] = clean(corner.uv[k]);
        corner.emissionUv[k] = clean(corner.emissionUv[k]);
    }
    for (int k = 0; k < 3; ++k) corner.tint[k] = std::clamp(clean(corner.tint[k]), 0.0F, 1.0F);
    return corner;
}

/// As the kernels see it: a normal number in single precision, whose square is finite.
bool hasArea(const Scene& scene, const Polygon& polygon) {
    const auto area = static_cast<float>(polygonArea(scene, polygon));
    return std::isnormal(area) && std::isfinite(area * area);
}

} // namespace

Rgb notAboveLargest(const Rgb& factor) {
    const bool atMostWhite = glm::all(glm::lessThanEqual(factor, Rgb(1.0F)));
    return atMostWhite ? glm::min(factor, kMaxReflectance) : factor;
}

SceneBuilder::SceneBuilder(std::string file, const ReadOptions& options) : file_(std::move(file)), options_(options) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file_, error);
    if (!error) countBytes(size);
    result_.scene.origin = options_.origin.value_or(glm::dvec3(0.0));
}

std::uintmax_t SceneBuilder::mostPolygons() const {
    return options_.mostPolygons != 0 ? options_.mostPolygons : kPolygonsOfAnyFile + bytes_;
}

void SceneBuilder::requireFewerThan(std::uintmax_t most, std::size_t count, const char* what) const {
    if (count >= most)
        throw InputError(
            fmt::format("{}: found more {} than allowed ({}); --most-polygons allows more", file_, what, most));
}

void SceneBuilder::reserve(std::size_t positions, std::size_t polygons) {
    result_.scene.positions.reserve(positions);
    result_.scene.polygons.reserve(polygons);
}

std::uint32_t SceneBuilder::addPosition(const glm::dvec3& metres) {
    auto& positions = result_.scene.positions;
    if (positions.size() >= kNone)
        throw InputError(fmt::format("{}: found more vertices than allowed ({})", file_, kNone));
    requireFewerThan(4 * mostPolygons(), positions.size(), "vertices");
    positions.push_back(local(metres));
    if (!options_.origin) rounding_.emplace_back(metres - glm::dvec3(positions.back()));
    return static_cast<std::uint32_t>(positions.size() - 1);
}

std::uint32_t SceneBuilder::addMaterial(Material material) {
    const Rgb reflectance = glm::clamp(material.reflectance, 0.0F, kMaxReflectance);
    const Rgb emittedRadiance = glm::clamp(material.emittedRadiance, 0.0F, kMaxEmission);
    std::string changes;
    if (reflectance != material.reflectance)
        changes = fmt::format("reflectance {:g} {:g} {:g} clamped to 0 ... {} (no surface returns all light)",
                              material.reflectance.x, material.reflectance.y, material.reflectance.z, kMaxReflectance);
    if (emittedRadiance != material.emittedRadiance)
        changes += fmt::format("{}emission {:g} {:g} {:g} clamped to 0 ... {:g}", changes.empty() ? "" : "; ",
                               material.emittedRadiance.x, material.emittedRadiance.y, material.emittedRadiance.z,
                               kMaxEmission);
    if (!changes.empty()) warn(fmt::format("material {}: {}", inQuotes(material.name), changes));

    material.reflectance = reflectance;
    material.emittedRadiance = emittedRadiance;
    material.twoSided = material.twoSided || options_.twoSided;
    result_.scene.materials.push_back(std::move(material));
    return static_cast<std::uint32_t>(result_.scene.materials.size() - 1);
}

std::uint32_t SceneBuilder::addNode(std::string name) {
    result_.scene.nodes.push_back(std::move(name));
    return static_cast<std::uint32_t>(result_.scene.nodes.size() - 1);
}

void SceneBuilder::warn(const std::string& text) { result_.report.warnings.push_back(file_ + ": " + text); }

void SceneBuilder::warnUnlessStrict(const std::string& text) {
    if (options_.strict) throw InputError(file_ + ": " + text);
    warn(text);
}

std::uint32_t SceneBuilder::addTextureFile(const std::filesystem::path& folder, const std::string& name,
                                           TextureContent content, const std::string& replacement) {
    const std::string key = fmt::format("{} {}", static_cast<int>(content), (folder / name).string());
    const auto [entry, isNew] = textures_.try_emplace(key, kNone);
    if (!isNew) return entry->second;
    if (auto texture = readTextureFile(folder, name, content, replacement))
        entry->second = addTexture(std::move(texture));
    return entry->second;
}

template <typename Read>
std::shared_ptr<const Texture> SceneBuilder::textureOrNull(const std::string& name, const std::string& replacement,
                                                           Read&& read) {
    try {
        return read();
    } catch (const InputError& error) {
        ++result_.report.missingImages;
        warnUnlessStrict(fmt::format("image {}: {}; {}", inQuotes(asUtf8(name)), error.what(), replacement));
        return nullptr;
    }
}

std::shared_ptr<const Texture> SceneBuilder::readTextureFile(const std::filesystem::path& folder,
                                                             const std::string& name, TextureContent content,
                                                             const std::string& replacement) {
    return textureOrNull(name, replacement, [&] { return readTexture(namedFile(folder, name, options_), content); });
}

std::shared_ptr<const Texture> SceneBuilder::readTextureBytes(std::span<const std::uint8_t> bytes,
                                                              const std::string& name, TextureContent content,
                                                              const std::string& replacement) {
    return textureOrNull(name, replacement, [&] { return readTexture(bytes, name, content); });
}

std::uint32_t SceneBuilder::addTexture(std::shared_ptr<const Texture> texture) {
    result_.scene.textures.push_back(std::move(texture));
    return static_cast<std::uint32_t>(result_.scene.textures.size() - 1);
}

void SceneBuilder::addPolygon(std::span<const std::uint32_t> vertices, std::uint32_t material, std::uint32_t node,
                              std::span<const CornerSurface> surface) {
    ReadReport& report = result_.report;
    const auto& positions = result_.scene.positions;
    requireFewerThan(mostPolygons(), report.inputPolygons, "polygons");
    ++report.inputPolygons;
    if (!std::all_of(vertices.begin(), vertices.end(),
                     [&](std::uint32_t vertex) { return isFinite(positions[vertex]); })) {
        ++report.nonFinitePolygons;
        return;
    }
    growBounds(vertices);

    const auto coincide = [&](std::uint32_t a, std::uint32_t b) { return positions[a] == positions[b]; };
    corners_.clear();
    surface_.clear();
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        if (!corners_.empty() && coincide(corners_.back(), vertices[k])) continue;
        corners_.push_back(vertices[k]);
        if (!surface.empty()) surface_.push_back(finite(surface[k]));
    }
    while (corners_.size() > 1 && coincide(corners_.front(), corners_.back())) {
        corners_.pop_back();
        if (!surface_.empty()) surface_.pop_back();
    }

    material_ = material;
    node_ = node;
    bool kept = false;
    if (corners_.size() == 3) {
        kept = addTriangle(0, 1, 2);
    } else if (corners_.size() == 4) {
        kept = addQuad();
    } else if (corners_.size() > 4) {
        kept = addSplit();
    }
    if (!kept) ++report.degeneratePolygons;
}

bool SceneBuilder::addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    Polygon triangle{{corners_[a], corners_[b], corners_[c], kNone}, material_, node_};
    if (!hasArea(result_.scene, triangle)) return false;
    triangle.surface = cornerSurface(a, b, c, kNone);
    result_.scene.polygons.push_back(triangle);
    return true;
}

void SceneBuilder::growBounds(std::span<const std::uint32_t> vertices) {
    for (const std::uint32_t vertex : vertices) {
        const glm::dvec3 rounding = rounding_.empty() ? glm::dvec3(0.0) : glm::dvec3(rounding_[vertex]);
        bounds_.add(glm::dvec3(result_.scene.positions[vertex]) + rounding);
    }
}

/// The surface of a polygon with these corners, into Scene::surfaces.
std::uint32_t SceneBuilder::cornerSurface(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    if (surface_.empty()) return kNone;
    SurfaceCorners result;
    const std::array corners{a, b, c, d};
    for (std::size_t k = 0; k < 4; ++k) {
        if (corners[k] == kNone) continue;
        const CornerSurface& source = surface_[corners[k]];
        result.uv[k] = source.uv;
        result.emissionUv[k] = source.emissionUv;
        result.tint[k] = source.tint;
    }
    result_.scene.surfaces.push_back(result);
    return static_cast<std::uint32_t>(result_.scene.surfaces.size() - 1);
}

bool SceneBuilder::addQuad() {
    Polygon quad{{corners_[0], corners_[1], corners_[2], corners_[3]}, material_, node_};
    if (!hasArea(result_.scene, quad)) return false;

    std::array<glm::dvec3, 4> points;
    for (std::size_t k = 0; k < 4; ++k) points[k] = glm::dvec3(result_.scene.positions[corners_[k]]);
    const glm::dvec3 normal = glm::normalize(newellNormal(points));
    if (!isConvex(points, normal)) return addSplit();

    const double diagonal02 = glm::distance(points[0], points[2]);
    const double diagonal13 = glm::distance(points[1], points[3]);
    if (offPlane(points, normal) <= kMaxOffPlane * std::max(diagonal02, diagonal13)) {
        quad.surface = cornerSurface(0, 1, 2, 3);
        result_.scene.polygons.push_back(quad);
        return true;
    }

    const std::uint32_t first = diagonal02 <= diagonal13 ? 0 : 1;
    const bool kept0 = addTriangle(first, first + 1, first + 2);
    const bool kept1 = addTriangle(first, first + 2, (first + 3) % 4);
    if (kept0 || kept1) ++result_.report.splitPolygons;
    return kept0 || kept1;
}

bool SceneBuilder::addSplit() {
    std::vector<glm::dvec3> points;
    for (const std::uint32_t vertex : corners_) points.emplace_back(result_.scene.positions[vertex]);
    const glm::dvec3 normal = newellNormal(points);
    const double size = glm::length(normal);

    std::optional<std::vector<std::array<std::uint32_t, 3>>> triangles;
    if (size > 0.0) triangles = triangulatePolygon(projected(points, normal / size), points.size());
    const bool fan = !triangles || triangles->empty();
    // A fan of thousands lies over itself thousands of times: whatever it was meant to be, it is not that.
    if (fan && corners_.size() > kMostFanCorners) {
        ++droppedFans_;
        return false;
    }
    if (fan) {
        triangles.emplace();
        for (std::uint32_t k = 1; k + 1 < corners_.size(); ++k) triangles->push_back({0, k, k + 1});
    }
    bool kept = false;
    for (const auto& [a, b, c] : *triangles) kept |= addTriangle(a, b, c);
    if (!kept) return false;
    ++result_.report.splitPolygons;
    if (fan) ++fans_;
    return true;
}

bool SceneBuilder::addPolygonWithHoles(std::span<const std::uint32_t> vertices, std::span<const std::size_t> loopSizes,
                                       std::uint32_t material, std::uint32_t node) {
    const std::span<const std::uint32_t> border = vertices.first(loopSizes.front());
    std::vector<glm::dvec3> points;
    for (const std::uint32_t vertex : vertices) points.emplace_back(result_.scene.positions[vertex]);
    const glm::dvec3 normal = newellNormal(std::span(points).first(border.size()));
    const double size = glm::length(normal);
    if (!(size > 0.0) || !std::isfinite(size)) {
        addPolygon(border, material, node); // which counts it as what it is
        return true;
    }

    const std::vector<glm::dvec2> plane = projected(points, normal / size);
    const auto triangles = triangulateLoops(plane, loopSizes);
    const double expected = areaWithHoles(plane, loopSizes);
    constexpr double kRounding = 1e-6; // of the border's area; anything larger is a hole in the wrong place
    if (!triangles || !(std::abs(areaOf(*triangles, plane) - expected) <= kRounding * 0.5 * size)) {
        addPolygon(border, material, node);
        return false;
    }

    ++result_.report.inputPolygons;
    growBounds(border);
    corners_.assign(vertices.begin(), vertices.end());
    surface_.clear();
    material_ = material;
    node_ = node;
    bool kept = false;
    for (const auto& [a, b, c] : *triangles) kept |= addTriangle(a, b, c);
    ++(kept ? result_.report.splitPolygons : result_.report.degeneratePolygons);
    return true;
}

void SceneBuilder::noteSinglePrecision(const glm::vec3& stored, double metres) {
    const float largest = std::max({std::abs(stored.x), std::abs(stored.y), std::abs(stored.z)});
    if (static_cast<double>(largest) * metres * std::numeric_limits<float>::epsilon() <= coarsest_) return;
    const float next = std::nextafter(largest, std::numeric_limits<float>::infinity());
    if (std::isfinite(next)) coarsest_ = std::max(coarsest_, static_cast<double>(next - largest) * metres);
}

/// Of a file that has its coordinates in single precision, and so far from its origin that this shows.
void SceneBuilder::warnOfRounding() {
    if (coarsest_ > kCoarse * bounds_.diagonal())
        warn(fmt::format("coordinates are rounded to {:.2g} m: the file has them in single precision and far from its "
                         "origin, in a scene of {:.3g} m; write them nearer to the origin, or in double precision",
                         coarsest_, bounds_.diagonal()));
}

ReadResult SceneBuilder::finish() {
    const ReadReport& report = result_.report;
    if (!options_.origin) {
        result_.report.neededOrigin = distantOrigin(bounds_);
        if (report.neededOrigin != glm::dvec3(0.0)) return std::exchange(result_, {});
    }
    if (result_.scene.polygons.empty()) {
        if (report.inputPolygons == 0) throw InputError(file_ + ": found no polygons, expected at least one");
        throw InputError(fmt::format("{}: found no usable polygon among {}: {} with a coordinate that is not "
                                     "finite, {} without area",
                                     file_, report.inputPolygons, report.nonFinitePolygons, report.degeneratePolygons));
    }
    if (const float size = boundsOf(result_.scene).diagonal(); size < kSmallestScene)
        throw InputError(
            fmt::format("{}: found a scene of {:.3g} m, expected at least {:.0e} m; --unit METRES scales it, "
                        "where it is not glTF",
                        file_, size, kSmallestScene));
    if (droppedFans_ > 0)
        warn(fmt::format("{} polygons of more than {} corners cross themselves and were dropped", droppedFans_,
                         kMostFanCorners));
    if (fans_ > 0)
        warn(fmt::format("{} polygons touch or cross themselves and were split into fans of triangles", fans_));
    warnOfRounding();
    result_.report.warnings = mergeWarnings(result_.report.warnings);
    return std::exchange(result_, {});
}

} // namespace lambert
