#include "rendering/default_camera.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace lambert {

namespace {

constexpr float kOutsideFov = 45.0F; // degrees
constexpr float kInsideFov = 65.0F;
constexpr float kElevation = 30.0F;
const glm::vec3 kUp(0.0F, 1.0F, 0.0F);

/// In the order in which they are preferred.
const std::array<glm::vec3, 6> kSides{glm::vec3(0, 0, 1),  glm::vec3(0, 0, -1), glm::vec3(1, 0, 0),
                                      glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0),  glm::vec3(0, -1, 0)};

/// Whether most rays from the middle of the bounding box toward `side` leave the scene.
bool isOpen(const RayCaster& caster, const glm::vec3& side) {
    constexpr int kRays = 9; // per axis
    const Bounds& bounds = caster.bounds();
    const glm::vec3 centre = 0.5F * (bounds.lower + bounds.upper);
    const glm::vec3 axisX(side.y, side.z, side.x);
    const glm::vec3 axisY(side.z, side.x, side.y);
    const float offset = caster.originOffset(bounds.diagonal()); // off the one plane of a flat scene
    int leaving = 0;
    for (int i = 0; i < kRays; ++i) {
        for (int j = 0; j < kRays; ++j) {
            // Spread over the middle 60 % of the box, off the planes of symmetry, on which scenes have their
            // edges.
            const float x = 0.6F * ((static_cast<float>(i) + 0.37F) / static_cast<float>(kRays) - 0.5F);
            const float y = 0.6F * ((static_cast<float>(j) + 0.41F) / static_cast<float>(kRays) - 0.5F);
            const glm::vec3 origin = centre + offset * side + bounds.size() * (x * axisX + y * axisY);
            if (!caster.occluded(Ray{origin, side})) ++leaving;
        }
    }
    return 2 * leaving > kRays * kRays;
}

/// How much a camera shows, in [-1, 1]: the share of its rays that meet fronts, far ones counting more, minus
/// the share that meet backs.
float score(const RayCaster& caster, const Camera& camera, float aspect) {
    constexpr int kRays = 16;
    const CameraRays rays(camera, kRays, kRays);
    const float nearby = 0.1F * caster.bounds().diagonal();
    float sum = 0.0F;
    for (int y = 0; y < kRays; ++y) {
        for (int x = 0; x < kRays; ++x) {
            const float centred = static_cast<float>(x) + 0.5F - 0.5F * kRays;
            const glm::vec3 direction = rays.direction(0.5F * kRays + aspect * centred, static_cast<float>(y) + 0.5F);
            const std::optional<Hit> hit = caster.closest(Ray{camera.eye, direction});
            if (!hit) continue;
            const float distance = hit->distance * glm::length(direction);
            const bool front = hit->front || caster.scene().polygons[hit->polygon].backMaterial != kNone;
            sum += front ? distance / (distance + nearby) : -1.0F;
        }
    }
    return sum / static_cast<float>(kRays * kRays);
}

/// Looks at the centre of the box along −`from`, from just so far that all eight corners are in the picture.
Camera outsideCamera(const Bounds& bounds, const glm::vec3& from, float aspect) {
    constexpr float kMargin = 1.05F;
    const glm::vec3 centre = 0.5F * (bounds.lower + bounds.upper);
    const glm::vec3 view = -glm::normalize(from);
    const glm::vec3 up = std::abs(view.y) > 0.99F ? glm::vec3(0.0F, 0.0F, view.y) : kUp;
    const glm::vec3 right = glm::normalize(glm::cross(view, up));
    const glm::vec3 pictureUp = glm::cross(right, view);
    const float tangent = std::tan(0.5F * glm::radians(kOutsideFov));
    float distance = 0.01F * bounds.diagonal();
    for (int k = 0; k < 8; ++k) {
        const glm::vec3 sign((k & 1) != 0 ? 0.5F : -0.5F, (k & 2) != 0 ? 0.5F : -0.5F, (k & 4) != 0 ? 0.5F : -0.5F);
        const glm::vec3 corner = sign * bounds.size();
        const float extent =
            std::max(std::abs(glm::dot(corner, right)) / aspect, std::abs(glm::dot(corner, pictureUp)));
        distance = std::max(distance, kMargin * extent / tangent - glm::dot(corner, view));
    }
    return lookAtCamera(centre - distance * view, centre, up, kOutsideFov);
}

/// Cameras inside the box, those farther toward its corners first.
std::vector<Camera> insideCameras(const Bounds& bounds) {
    const glm::vec3 centre = 0.5F * (bounds.lower + bounds.upper);
    std::vector<Camera> cameras;
    for (const float reach : {0.9F, 0.7F, 0.5F, 0.25F}) {
        for (const float height : {0.6F, 0.4F}) {
            for (const glm::vec3& corner :
                 {glm::vec3(1, 0, 1), glm::vec3(-1, 0, 1), glm::vec3(1, 0, -1), glm::vec3(-1, 0, -1)}) {
                glm::vec3 eye = centre + 0.5F * reach * corner * bounds.size();
                eye.y = bounds.lower.y + height * bounds.size().y;
                cameras.push_back(lookAtCamera(eye, centre, kUp, kInsideFov));
            }
        }
    }
    return cameras;
}

/// The first of the cameras with the highest score.
struct Best {
    std::optional<Camera> camera;
    float score = 0.0F;

    void offer(const Camera& candidate, float candidateScore) {
        if (camera && candidateScore <= score) return;
        camera = candidate;
        score = candidateScore;
    }
};

} // namespace

Camera defaultCamera(const Scene& scene, const RayCaster& caster, float aspect) {
    if (scene.polygons.empty()) return Camera{};
    const Bounds& bounds = caster.bounds();
    const bool topOpen = isOpen(caster, kUp);
    Best best;
    for (const glm::vec3& side : kSides) {
        if (!isOpen(caster, side)) continue;
        const bool vertical = side.y != 0.0F;
        const glm::vec3 raised = side + std::tan(glm::radians(kElevation)) * kUp;
        const Camera camera = outsideCamera(bounds, topOpen && !vertical ? raised : side, aspect);
        // A plan shows most of a floor, but one recognises a scene from the side.
        best.offer(camera, (vertical ? 0.25F : 1.0F) * score(caster, camera, aspect));
    }
    // What is open only because the box reaches beyond the walls, of an L-shaped room, shows backs from outside.
    if (best.camera && best.score > 0.0F) return *best.camera;
    for (const Camera& camera : insideCameras(bounds)) best.offer(camera, score(caster, camera, aspect));
    return *best.camera;
}

} // namespace lambert
