#pragma once

#include "picture/camera_rays.h"
#include "scene/rays/ray_caster.h"

namespace lambert {

/// A camera for a scene that has none and a user who names none. +Y is up.
///
/// If the scene is open on some side (most rays from its middle along an axis leave it), the camera stands in
/// front of the open side from which it sees most fronts (of the top or the bottom only if the other sides
/// show little), far enough that the whole bounding box is in the picture (45° vertical field of view,
/// `aspect` = width / height); raised by 30° if the top is open as well. A closed scene is seen from inside:
/// near a corner of its bounding box, from which fronts are seen at a distance, toward the centre (65°). The
/// same scene always gives the same camera.
Camera defaultCamera(const Scene& scene, const RayCaster& caster, float aspect = 1.0F);

} // namespace lambert
