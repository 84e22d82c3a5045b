#include "formfactors/viewpoints.h"

#include "core/error.h"
#include "core/random.h"
#include "core/sample_points.h"
#include "formfactors/patch_sampling.h"
#include "meshing/patch_offset.h"

#include <fmt/format.h>

#include <numbers>

namespace lambert {

void checkPerPatch(int perPatch) {
    if (perPatch < 1 || perPatch > 1024)
        throw UsageError(fmt::format("points per patch: found {}, allowed are 1 to 1024", perPatch));
}

Viewpoint viewpoint(const PatchMesh& mesh, const RayCaster& rays, std::uint32_t patch, int index,
                    const ViewOptions& options) {
    glm::vec3 point = mesh.centroid[patch];
    if (options.perPatch > 1) {
        const SamplePoints points(Sampler::Stratified, static_cast<std::uint32_t>(options.perPatch), 2,
                                  randomKey({patch, 0, 0, 0x56494557}, options.seed));
        const auto k = static_cast<std::uint32_t>(index);
        point = PatchPoints(mesh, patch).at({points.at(k, 0), points.at(k, 1)});
    }
    return {point + patchOriginOffset(rays, mesh, patch) * mesh.normal[patch], viewAngle(patch, index, options)};
}

float viewAngle(std::uint32_t index, int k, const ViewOptions& options) {
    if (!options.randomRotation) return 0.0F;
    const auto random = philox({index, static_cast<std::uint32_t>(k), 0, 0}, options.seed);
    return 2.0F * std::numbers::pi_v<float> * uniformFloat(random[0]);
}

} // namespace lambert
