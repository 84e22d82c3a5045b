#include "picture/camera_rays.h"

#include "core/error.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace lambert {

CameraRays::CameraRays(const Camera& camera, int width, int height) {
    const glm::vec3 right = glm::normalize(glm::cross(camera.direction, camera.up));
    const glm::vec3 up = glm::cross(right, camera.direction);
    const float halfHeight = std::tan(0.5F * camera.verticalFov);
    const float pixel = 2.0F * halfHeight / static_cast<float>(height);
    perPixelX_ = pixel * right;
    perPixelY_ = -pixel * up;
    corner_ = camera.direction - 0.5F * static_cast<float>(width) * perPixelX_ -
              0.5F * static_cast<float>(height) * perPixelY_;
}

Camera lookAtCamera(const glm::vec3& eye, const glm::vec3& lookAt, const glm::vec3& up, float fovDegrees) {
    const auto text = [](const glm::vec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); };
    for (const glm::vec3& v : {eye, lookAt, up})
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(v[c])) throw UsageError(fmt::format("camera: {} is not finite", text(v)));
    if (!(fovDegrees > 0.0F && fovDegrees < 180.0F))
        throw UsageError(
            fmt::format("camera: the field of view is {} degrees; it must lie between 0 and 180", fovDegrees));
    if (eye == lookAt) throw UsageError(fmt::format("camera: eye and look-at are the same point, {}", text(eye)));
    Camera camera;
    camera.eye = eye;
    // In double: squares of large or small coordinates leave the range of float.
    const glm::dvec3 direction = glm::normalize(glm::dvec3(lookAt) - glm::dvec3(eye));
    const double upLength = glm::length(glm::dvec3(up));
    if (upLength == 0.0) throw UsageError("camera: up is the zero vector");
    const glm::dvec3 unitUp = glm::dvec3(up) / upLength;
    if (glm::length(glm::cross(direction, unitUp)) < 1e-4)
        throw UsageError(
            fmt::format("camera: up ({}) is parallel to the view from {} to {}", text(up), text(eye), text(lookAt)));
    camera.direction = glm::vec3(direction);
    camera.up = glm::vec3(unitUp);
    camera.verticalFov = glm::radians(fovDegrees);
    return camera;
}

} // namespace lambert
