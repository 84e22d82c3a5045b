#pragma once

#include "meshing/patch_optics.h"
#include "scene/rays/ray_caster.h"
#include "scene/scene.h"

namespace lambert {

/// Aborts with `promise` on stderr unless it is kept. Not an exception, so that a fuzzer keeps the input and a debugger
/// the stack.
void require(bool kept, const char* promise);

/// What the readers and prepareScene promise: indices in range, polygons finite and with an area, reflectances from 0 to
/// 0.99, numbers of materials, surfaces, cameras and lights finite and in the ranges of scene.h.
void requireSoundScene(const Scene& scene);

/// That there are texels, and that each is finite and not negative.
void requireSoundTexture(const Texture& texture);

/// That the patches have corners, area, unit normals and light that kernels can compute with.
void requireSoundMesh(const Scene& scene, const PatchMesh& mesh);

/// That a hit lies on a polygon and on a patch of it.
void requireSoundHit(const Scene& scene, const PatchMesh& mesh, const Hit& hit);

} // namespace lambert
