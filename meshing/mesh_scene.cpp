#include "meshing/mesh_scene.h"

#include "core/error.h"
#include "meshing/hidden_patches.h"
#include "scene/environment.h"

#include <algorithm>

namespace lambert {

namespace {

/// Whether there is a light without area that is not black.
bool shinesWithoutArea(const Scene& scene) {
    const Environment* const sky = scene.environment.get();
    return std::any_of(scene.lights.begin(), scene.lights.end(),
                       [](const PunctualLight& light) { return light.intensity != Rgb(0.0F); }) ||
           (sky != nullptr && (sky->distribution() != nullptr || Rgb(sky->radiance({0.0, 1.0, 0.0})) != Rgb(0.0F)));
}

void requireLight(const Scene& scene) {
    const bool lit = std::any_of(scene.polygons.begin(), scene.polygons.end(), [&](const Polygon& polygon) {
        return scene.materials[polygon.material].emittedRadiance != Rgb(0.0F);
    });
    if (!lit)
        throw InputError("the scene has no light: no material that is used emits, and there is no light without area; "
                         "give one with --emit MATERIAL=r,g,b");
}

/// What no material's constants tell: an emission texture may be black.
void requireLight(const PatchOptics& optics) {
    const auto& emitted = optics.emittedRadiosity;
    if (std::all_of(emitted.begin(), emitted.end(), [](const Rgb& b) { return b == Rgb(0.0F); }))
        throw InputError("the scene has no light: wherever a material emits, its emission texture is black or has a "
                         "hole; give another light with --emit MATERIAL=r,g,b");
}

} // namespace

MeshedScene meshScene(const Scene& scene, const MeshOptions& options, Progress& progress) {
    MeshedScene result;
    const bool keepPolygons = !options.patchLength && options.patches == std::size_t{0};
    progress.begin("mesh", 0);
    result.scene = std::make_shared<Scene>(prepareScene(scene, {keepPolygons}, &result.prepareReport));
    if (result.scene->polygons.empty()) throw InputError("the scene has no polygons of any size");
    result.rays = std::make_unique<RayCaster>(*result.scene);
    result.mesh = buildPatchMesh(*result.scene, options, progress, &result.meshReport);
    result.optics = patchOptics(*result.scene, result.mesh);
    std::vector<bool> hidden = findHiddenPatches(*result.rays, result.mesh, result.optics);
    if (std::find(hidden.begin(), hidden.end(), true) != hidden.end()) result.mesh.hidden = std::move(hidden);
    progress.end();
    return result;
}

MeshedScene meshLitScene(const Scene& scene, const MeshOptions& options, Progress& progress) {
    const bool needsEmitter = !shinesWithoutArea(scene);
    if (needsEmitter) requireLight(scene);
    MeshedScene result = meshScene(scene, options, progress);
    if (needsEmitter) requireLight(result.optics);
    return result;
}

} // namespace lambert
