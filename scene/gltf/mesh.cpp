#include "scene/gltf/mesh.h"

#include "scene/gltf/document.h"
#include "scene/gltf/nodes.h"

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>

namespace lambert {

namespace {

std::size_t trianglesOf(int mode, std::size_t corners) {
    if (mode == gltf::kTriangles) return corners / 3;
    return corners < 3 ? 0 : corners - 2;
}

/// The corners of triangle `k` of a list, strip or fan, in the order that shows the front.
std::array<std::size_t, 3> triangleCorners(int mode, std::size_t k) {
    if (mode == gltf::kTriangles) return {3 * k, 3 * k + 1, 3 * k + 2};
    if (mode == gltf::kTriangleStrip) return {k, k + 1 + k % 2, k + 2 - k % 2};
    return {0, k + 1, k + 2};
}

glm::vec2 uvOf(const std::optional<GltfTextureCoordinates>& use, const std::optional<GltfAccessor>& accessor,
               std::size_t vertex) {
    if (!use) return glm::vec2(0.0F);
    const glm::vec4 coordinates = accessor ? accessor->element(vertex) : glm::vec4(0.0F);
    return use->toUv * glm::vec3(coordinates.x, coordinates.y, 1.0F);
}

} // namespace

std::size_t GltfMeshes::triangleCount(int mesh) const {
    const auto& primitives = model_.meshes[static_cast<std::size_t>(mesh)].primitives;
    std::size_t sum = 0;
    for (std::size_t k = 0; k < primitives.size(); ++k) {
        const gltf::Primitive& primitive = primitives[k];
        const std::string place = fmt::format("/meshes/{}/primitives/{}", mesh, k);
        const auto positions = primitive.attributes.find("POSITION");
        if (primitive.mode < gltf::kTriangles || positions == primitive.attributes.end()) continue;
        const GltfAccessor corners =
            primitive.indices >= 0
                ? GltfAccessor(file_, model_, primitive.indices, GltfAccessor::Use::Indices, place + "/indices")
                : GltfAccessor(file_, model_, positions->second, GltfAccessor::Use::Vectors,
                               place + "/attributes/POSITION");
        sum += trianglesOf(primitive.mode, corners.count());
    }
    return sum;
}

void GltfMeshes::add(int mesh, const glm::dmat4& toWorld, std::uint32_t node) {
    const auto index = static_cast<std::size_t>(mesh);
    added_.resize(model_.meshes.size());
    isFirstCopy_ = !added_[index];
    added_[index] = true;
    runPositions_.reset();
    const auto& primitives = model_.meshes[index].primitives;
    for (std::size_t k = 0; k < primitives.size(); ++k)
        addPrimitive(primitives[k], fmt::format("/meshes/{}/primitives/{}", mesh, k), toWorld, node);
}

void GltfMeshes::report() {
    if (ignoredPrimitives_ > 0)
        builder_.warn(fmt::format("{} primitives of points or lines were ignored", ignoredPrimitives_));
    if (invisibleTriangles_ > 0)
        builder_.warn(
            fmt::format("{} triangles were left out: alphaMode MASK makes them invisible", invisibleTriangles_));
    if (bareTextures_ > 0)
        builder_.warn(
            fmt::format("{} primitives lack the texture coordinates of their material: (0, 0) is used", bareTextures_));
    if (morphed_) builder_.warn("morph targets are not applied");
}

void GltfMeshes::addPrimitive(const gltf::Primitive& primitive, const std::string& place, const glm::dmat4& toWorld,
                              std::uint32_t node) {
    if (primitive.mode > gltf::kTriangleFan)
        failAtMember(file_, place + "/mode", std::to_string(primitive.mode), "0 to 6");
    if (primitive.mode < gltf::kTriangles) {
        if (isFirstCopy_) ++ignoredPrimitives_;
        return;
    }
    const Source source = sourceOf(primitive, place);
    morphed_ |= primitive.hasTargets;
    if (primitive.mode == gltf::kTriangles && source.cornerCount() % 3 != 0)
        failAtMember(file_, place, fmt::format("triangles with {} corners", source.cornerCount()), "a multiple of 3");

    const std::size_t triangles = trianglesOf(primitive.mode, source.cornerCount());
    if (source.material.isInvisible) {
        invisibleTriangles_ += triangles;
        return;
    }
    const bool mirrored = glm::determinant(glm::dmat3(toWorld)) < 0.0;
    constexpr std::size_t kReportEvery = 1 << 16;
    const bool isTextured = source.material.uv || source.material.emissionUv;
    for (std::size_t t = 0; t < triangles; ++t) {
        if ((t + 1) % kReportEvery == 0) progress_.advance(kReportEvery);
        std::array<std::size_t, 3> corners = triangleCorners(primitive.mode, t);
        if (mirrored) std::swap(corners[1], corners[2]);
        std::array<std::uint32_t, 3> vertices{};
        std::array<SceneBuilder::CornerSurface, 3> surface{};
        bool isTinted = false;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t vertex = vertexIndex(source, primitive, corners[c]);
            vertices[c] = sceneVertex(source.positions, vertex, toWorld);
            surface[c].uv = uvOf(source.material.uv, source.uv, vertex);
            surface[c].emissionUv = uvOf(source.material.emissionUv, source.emissionUv, vertex);
            if (source.colours) surface[c].tint = Rgb(source.colours->element(vertex));
            isTinted |= surface[c].tint != Rgb(1.0F);
        }
        if (isTextured || isTinted) {
            builder_.addPolygon(vertices, source.material.index, node, surface);
        } else {
            builder_.addPolygon(vertices, source.material.index, node);
        }
    }
}

GltfMeshes::Source GltfMeshes::sourceOf(const gltf::Primitive& primitive, const std::string& place) {
    const auto positions = primitive.attributes.find("POSITION");
    if (positions == primitive.attributes.end())
        failAtMember(file_, place + "/attributes/POSITION", "nothing", "an accessor of positions");
    Source source{.positions = GltfAccessor(file_, model_, positions->second, GltfAccessor::Use::Vectors,
                                            place + "/attributes/POSITION")};
    const std::size_t count = source.positions.count();
    if (primitive.indices >= 0)
        source.indices.emplace(file_, model_, primitive.indices, GltfAccessor::Use::Indices, place + "/indices");
    source.material = materialOf(primitive, place);
    source.uv = coordinates(primitive, place, source.material.uv, count);
    source.emissionUv = coordinates(primitive, place, source.material.emissionUv, count);
    source.colours = attribute(primitive, place, "COLOR_0", GltfAccessor::Use::Colours, count);

    if (runPositions_ != positions->second) {
        runPositions_ = positions->second;
        ++run_;
        known_.resize(std::max(known_.size(), count));
    }
    return source;
}

/// An attribute of the primitive's `count` vertices, if it has it.
std::optional<GltfAccessor> GltfMeshes::attribute(const gltf::Primitive& primitive, const std::string& place,
                                                  const std::string& name, GltfAccessor::Use use,
                                                  std::size_t count) const {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return std::nullopt;
    const std::string member = fmt::format("{}/attributes/{}", place, name);
    GltfAccessor accessor(file_, model_, found->second, use, member);
    if (accessor.count() < count)
        failAtMember(file_, member, fmt::format("{} elements", accessor.count()),
                     fmt::format("{}, as in POSITION", count));
    return accessor;
}

std::optional<GltfAccessor> GltfMeshes::coordinates(const gltf::Primitive& primitive, const std::string& place,
                                                    const std::optional<GltfTextureCoordinates>& use,
                                                    std::size_t count) {
    if (!use) return std::nullopt;
    auto result =
        attribute(primitive, place, fmt::format("TEXCOORD_{}", use->set), GltfAccessor::Use::TextureCoordinates, count);
    if (!result && isFirstCopy_) ++bareTextures_;
    return result;
}

GltfMaterial GltfMeshes::materialOf(const gltf::Primitive& primitive, const std::string& place) {
    if (primitive.material < 0) {
        if (!defaultMaterial_) defaultMaterial_ = GltfMaterial{.index = builder_.addMaterial({.name = "default"})};
        return *defaultMaterial_;
    }
    return gltfElement(file_, materials_, "materials", primitive.material, place + "/material");
}

std::size_t GltfMeshes::vertexIndex(const Source& source, const gltf::Primitive& primitive, std::size_t corner) const {
    if (!source.indices) return corner;
    const std::size_t vertex = source.indices->index(corner);
    if (vertex >= source.positions.count())
        failAtMember(file_, fmt::format("/accessors/{}", primitive.indices),
                     fmt::format("index {} as element {}", vertex, corner),
                     fmt::format("indices below {} (the number of vertices)", source.positions.count()));
    return vertex;
}

std::uint32_t GltfMeshes::sceneVertex(const GltfAccessor& positions, std::size_t vertex, const glm::dmat4& toWorld) {
    Known& known = known_[vertex];
    if (known.run != run_) {
        const glm::vec3 stored(positions.element(vertex));
        builder_.noteSinglePrecision(stored, largestScale(toWorld));
        known = {run_, builder_.addPosition(glm::dvec3(toWorld * glm::dvec4(stored, 1.0)))};
    }
    return known.vertex;
}

} // namespace lambert
