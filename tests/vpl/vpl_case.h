#pragma once

#include "meshing/prepare.h"
#include "scene/example_scenes.h"
#include "scene/rays/ray_caster.h"
#include "vpl/gather.h"
#include "vpl/particle_sources.h"
#include "vpl/trace_lights.h"

#include <vector>

namespace lambert {

/// A scene with what traces rays through it.
struct VplCase {
    explicit VplCase(const Scene& source) : scene(prepareScene(source)), rays(scene) {}

    VirtualPointLights trace(const TraceOptions& options) const {
        Progress progress;
        return traceLights(rays, options, progress);
    }
    Gathered gather(std::span<const VirtualPointLight> lights, std::span<const Receiver> receivers,
                    const GatherOptions& options) const {
        Progress progress;
        return gatherIrradiance(rays, lights, receivers, options, progress);
    }
    /// On the front of a polygon.
    Receiver receiver(std::uint32_t polygon, float u, float v) const {
        const SurfacePoint point = surfacePoint(rays, polygon, true, u, v);
        return {point.position, point.normal, point.lift};
    }
    /// n² on the front of every polygon, in the middle of equal parts of its chart.
    std::vector<Receiver> receivers(int n) const {
        std::vector<Receiver> result;
        for (std::uint32_t polygon = 0; polygon < scene.polygons.size(); ++polygon)
            for (int k = 0; k < n * n; ++k)
                result.push_back(receiver(polygon, (static_cast<float>(k % n) + 0.5F) / static_cast<float>(n),
                                          (static_cast<float>(k / n) + 0.5F) / static_cast<float>(n)));
        return result;
    }

    Scene scene;
    RayCaster rays;
};

} // namespace lambert
