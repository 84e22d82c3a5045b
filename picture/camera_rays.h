#pragma once

#include "picture/camera.h"

namespace lambert {

/// The rays of a pinhole camera through an image. They start at the camera's eye.
class CameraRays {
public:
    /// `width` and `height` in pixels, >= 1. Pixels are square.
    CameraRays(const Camera& camera, int width, int height);

    /// Direction (not of unit length) through the point (x, y) of the image, in pixels from its upper left
    /// corner; the centre of the first pixel is (0.5, 0.5).
    glm::vec3 direction(float x, float y) const { return corner_ + x * perPixelX_ + y * perPixelY_; }

private:
    glm::vec3 corner_, perPixelX_, perPixelY_;
};

/// A camera at `eye` that looks at `lookAt` (metres), with a vertical field of view of `fovDegrees`. Throws
/// UsageError if eye and lookAt coincide, `up` is zero or parallel to the view, anything is not finite, or
/// the angle is not between 0 and 180.
Camera lookAtCamera(const glm::vec3& eye, const glm::vec3& lookAt, const glm::vec3& up, float fovDegrees);

} // namespace lambert
