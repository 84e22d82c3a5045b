#pragma once

#include "meshing/patch_mesh.h"
#include "scene/ray_caster.h"
#include "solver/solution.h"
#include "vpl/receiver.h"

#include <cstdint>
#include <vector>

namespace lambert {

/// Direct light from the patches that emit, at points:
///
///     E(x) = Σ_e F(x, e) V̄ B_e,   V̄ = Σ_k G_k V_k / Σ_k G_k
///
/// F in closed form (see pointToPolygon), V̄ the visible share by shadow rays to points of the emitter: exact where all or nothing of
/// an emitter is seen. Not for emitters with textures or of more than 64 patches; these are better found by rays.
class EmitterLight {
public:
    /// `rays`, of the scene of `mesh`, must outlive it. `points` on all emitters together; a patch gets 16 at least.
    EmitterLight(const RayCaster& rays, const PatchMesh& mesh, std::uint32_t points, std::uint64_t seed);

    /// Whether it knows the emitters; else it gives nothing. True where there are none.
    bool isKnown() const { return known_; }
    /// E per m². Thread-safe.
    RgbSum irradiance(const Receiver& receiver) const;
    /// Its mean over `points` points of every patch, #patches.
    std::vector<RgbSum> irradiance(const PatchMesh& mesh, std::uint32_t points, std::uint64_t seed) const;

private:
    struct Emitter {
        std::vector<glm::dvec3> corners;
        glm::dvec3 normal;
        RgbSum radiosity;              ///< B_e
        std::vector<glm::vec3> points; ///< spread over it, somewhat above
    };
    double visibleShare(const Receiver& receiver, const Emitter& emitter) const;
    static double geometricTerm(const Receiver& receiver, const Emitter& emitter, const glm::dvec3& way);

    const RayCaster& rays_;
    std::vector<Emitter> emitters_;
    bool known_ = true;
};

} // namespace lambert
