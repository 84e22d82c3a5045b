#include "scene/mgf/geometry.h"

#include "core/text.h"
#include "scene/polygon_shape.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lambert {

namespace {

/// Whether two corners that are not neighbours coincide, as where a loop takes in a hole by a seam.
bool touchesItself(const std::vector<glm::dvec3>& corners) {
    std::vector<std::array<double, 3>> sorted;
    for (std::size_t k = 0; k < corners.size(); ++k)
        if (corners[k] != corners[(k + 1) % corners.size()])
            sorted.push_back({corners[k].x, corners[k].y, corners[k].z});
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

/// The names for a message: the first three.
std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t k = 0; k < std::min<std::size_t>(names.size(), 3); ++k)
        text += (k > 0 ? ", " : "") + inQuotes(names[k]);
    return names.size() > 3 ? fmt::format("{} and {} more", text, names.size() - 3) : text;
}

} // namespace

MgfGeometry::MgfGeometry(SceneBuilder& builder, MgfContexts& contexts, int curveSegments)
    : builder_(&builder), contexts_(&contexts), curveSegments_(curveSegments) {}

void MgfGeometry::setTransform(const glm::dmat4& toWorld) {
    toWorld_ = toWorld;
    mirrored_ = glm::determinant(glm::dmat3(toWorld)) < 0.0;
}

bool MgfGeometry::isSurface(std::string_view keyword) {
    constexpr std::array<std::string_view, 8> kSurfaces{"f", "fh", "prism", "sph", "cyl", "cone", "ring", "torus"};
    return std::find(kSurfaces.begin(), kSurfaces.end(), keyword) != kSurfaces.end();
}

void MgfGeometry::execute(const MgfEntity& entity) {
    const std::string_view keyword = entity.keyword();
    if (keyword == "f") addFace(entity);
    if (keyword == "fh") addFaceWithHoles(entity);
    if (keyword == "prism") addPrism(entity);
    if (keyword == "sph") addFacets(sphere(entity));
    if (keyword == "cyl") addFacets(cylinder(entity));
    if (keyword == "cone") addFacets(cone(entity));
    if (keyword == "ring") addFacets(ring(entity));
    if (keyword == "torus") addFacets(torus(entity));
}

void MgfGeometry::addFace(const MgfEntity& entity) {
    if (entity.argumentCount() < 3) entity.fail("f with at least three vertices");
    std::vector<glm::dvec3> corners;
    for (std::size_t k = 0; k < entity.argumentCount(); ++k) corners.push_back(vertex(entity, k).point);
    addLoop(entity, std::move(corners));
}

void MgfGeometry::addFaceWithHoles(const MgfEntity& entity) {
    std::vector<std::uint32_t> vertices;
    std::vector<std::size_t> loops{0};
    for (std::size_t k = 0; k < entity.argumentCount(); ++k) {
        if (entity.argument(k) == "-") {
            loops.push_back(0);
        } else {
            vertices.push_back(addPoint(vertex(entity, k).point));
            ++loops.back();
        }
    }
    if (*std::min_element(loops.begin(), loops.end()) < 3)
        entity.fail("fh with at least three vertices in the border and, after a - each, in every hole");
    if (mirrored_) std::reverse(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(loops.front()));
    if (!builder_->addPolygonWithHoles(vertices, loops, material(), node_))
        builder_->warn(
            fmt::format("the holes of a face cross each other or its border and were filled ({})", entity.place()));
}

void MgfGeometry::addPrism(const MgfEntity& entity) {
    if (entity.argumentCount() < 4) entity.fail("prism with at least three vertices and a length");
    const std::size_t count = entity.argumentCount() - 1;
    const double length = entity.number(count);
    if (length == 0.0) entity.fail(entity.argument(count), "a length other than 0");
    std::vector<glm::dvec3> base;
    for (std::size_t k = 0; k < count; ++k) base.push_back(vertex(entity, k).point);
    const glm::dvec3 area = newellNormal(base);
    if (!(glm::length(area) > 0.0)) entity.fail("prism with a base that has an area");
    const glm::dvec3 normal = area / glm::length(area);

    // The base looks along its normal, and the prism extends to the other side; a negative length turns all inside out.
    std::vector<glm::dvec3> end;
    for (const glm::dvec3& point : base) end.push_back(point - length * normal);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t next = (k + 1) % count;
        addLoop(entity, {base[next], base[k], end[k], end[next]});
    }
    addLoop(entity, base);
    addLoop(entity, {end.rbegin(), end.rend()});
}

Facets MgfGeometry::sphere(const MgfEntity& entity) const {
    entity.requireArguments(2, 2, "sph CENTRE RADIUS");
    const double radius = entity.number(1);
    if (radius == 0.0) entity.fail(entity.argument(1), "a radius other than 0");
    return sphereFacets(vertex(entity, 0).point, radius, curveSegments_);
}

Facets MgfGeometry::cone(const MgfEntity& entity) const {
    entity.requireArguments(4, 4, "cone V1 RADIUS1 V2 RADIUS2");
    const glm::dvec3 from = vertex(entity, 0).point, to = vertex(entity, 2).point;
    const double fromRadius = entity.number(1), toRadius = entity.number(3);
    if (from == to) entity.fail("two vertices that differ");
    if (std::min(fromRadius, toRadius) < 0.0 && std::max(fromRadius, toRadius) > 0.0)
        entity.fail("two radii of the same sign");
    if (fromRadius == 0.0 && toRadius == 0.0) entity.fail("a radius other than 0");
    return coneFacets(from, fromRadius, to, toRadius, curveSegments_);
}

Facets MgfGeometry::cylinder(const MgfEntity& entity) const {
    entity.requireArguments(3, 3, "cyl V1 RADIUS V2");
    const glm::dvec3 from = vertex(entity, 0).point, to = vertex(entity, 2).point;
    const double radius = entity.number(1);
    if (from == to) entity.fail("two vertices that differ");
    if (radius == 0.0) entity.fail(entity.argument(1), "a radius other than 0");
    return coneFacets(from, radius, to, radius, curveSegments_);
}

Facets MgfGeometry::ring(const MgfEntity& entity) const {
    entity.requireArguments(3, 3, "ring CENTRE INNER OUTER");
    const MgfVertex& centre = orientedVertex(entity, 0);
    const double inner = entity.number(1), outer = entity.number(2);
    if (inner < 0.0 || outer <= inner) entity.fail("an inner radius of 0 or more and a larger outer radius");
    return ringFacets(centre.point, centre.normal, inner, outer, curveSegments_);
}

Facets MgfGeometry::torus(const MgfEntity& entity) const {
    entity.requireArguments(3, 3, "torus CENTRE INNER OUTER");
    const MgfVertex& centre = orientedVertex(entity, 0);
    const double inner = entity.number(1), outer = entity.number(2);
    if (std::min(inner, outer) < 0.0 && std::max(inner, outer) > 0.0) entity.fail("two radii of the same sign");
    if (std::abs(outer) <= std::abs(inner)) entity.fail("an inner radius and a larger outer radius");
    return torusFacets(centre.point, centre.normal, inner, outer, curveSegments_);
}

void MgfGeometry::addFacets(const Facets& facets) {
    std::vector<std::uint32_t> vertices;
    for (const glm::dvec3& point : facets.points) vertices.push_back(addPoint(point));
    const std::uint32_t of = material();
    std::vector<std::uint32_t> corners;
    for (const auto& face : facets.faces) {
        corners.clear();
        for (const std::uint32_t corner : face)
            if (corner != kNone) corners.push_back(vertices[corner]);
        if (mirrored_) std::reverse(corners.begin(), corners.end());
        builder_->addPolygon(corners, of, node_);
    }
}

/// A polygon, front counter-clockwise before the transform.
void MgfGeometry::addLoop(const MgfEntity& entity, std::vector<glm::dvec3> corners) {
    if (mirrored_) std::reverse(corners.begin(), corners.end());
    std::vector<std::uint32_t> vertices;
    for (const glm::dvec3& point : corners) vertices.push_back(addPoint(point));
    if (!touchesItself(corners)) {
        builder_->addPolygon(vertices, material(), node_);
        return;
    }
    const std::array loops{vertices.size()};
    if (!builder_->addPolygonWithHoles(vertices, loops, material(), node_))
        builder_->warn(fmt::format("a face crosses itself ({})", entity.place()));
}

const MgfVertex& MgfGeometry::orientedVertex(const MgfEntity& entity, std::size_t k) const {
    const MgfVertex& result = vertex(entity, k);
    if (result.normal == glm::dvec3(0.0)) entity.fail(entity.argument(k), "a vertex with a normal");
    return result;
}

std::uint32_t MgfGeometry::addPoint(const glm::dvec3& point) {
    return builder_->addPosition(glm::dvec3(toWorld_ * glm::dvec4(point, 1.0)));
}

std::string MgfGeometry::materialName() {
    const std::string name = contexts_->materialName().empty() ? "unnamed" : asUtf8(contexts_->materialName());
    const std::size_t number = ++variants_[name];
    return number == 1 ? name : fmt::format("{}.{}", name, number);
}

/// The scene's index of the current material. One that was changed between its uses becomes several.
std::uint32_t MgfGeometry::material() {
    MgfMaterial& source = contexts_->material();
    if (source.index != kNone) return source.index;
    const RgbColour reflected = rgbOfUnitLuminance(source.reflectanceColour);
    const RgbColour emitted = rgbOfUnitLuminance(source.emissionColour);
    Material result;
    result.reflectance = Rgb(reflected.rgb * source.diffuseReflectance);
    result.emittedRadiance = Rgb(emitted.rgb * (source.emittance / glm::pi<double>()));
    result.twoSided = source.twoSided;

    const Rgb &r = result.reflectance, &e = result.emittedRadiance;
    const MaterialKey key{contexts_->materialName(), {r.x, r.y, r.z, e.x, e.y, e.z}, result.twoSided};
    const auto [entry, isNew] = materials_.try_emplace(key, kNone);
    if (isNew) {
        result.name = materialName();
        if ((reflected.clamped && source.diffuseReflectance > 0.0) || (emitted.clamped && source.emittance > 0.0))
            clampedMaterials_.push_back(result.name);
        if (!source.isDiffuse()) notDiffuseMaterials_.push_back(result.name);
        entry->second = builder_->addMaterial(std::move(result));
    }
    return source.index = entry->second;
}

void MgfGeometry::warnAboutMaterials() {
    if (!notDiffuseMaterials_.empty())
        builder_->warn(fmt::format("materials that reflect specularly or transmit light (rs, td, ts) count by their "
                                   "diffuse reflection rd only: {}",
                                   listed(notDiffuseMaterials_)));
    if (!clampedMaterials_.empty())
        builder_->warn(fmt::format("colours outside the gamut of Rec. 709 were clamped: of materials {}",
                                   listed(clampedMaterials_)));
}

} // namespace lambert
