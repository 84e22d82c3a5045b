#pragma once

#include "core/progress.h"
#include "meshing/patch_optics.h"
#include "scene/rays/ray_caster.h"
#include "solver/emitter_tree.h"
#include "solver/solution.h"

#include <cstdint>
#include <vector>

namespace lambert {

/// An irradiance, and what it may be off by.
struct EstimatedLight {
    RgbSum irradiance{0.0};    //!< E per m²
    RgbSum standardError{0.0}; //!< of its shadow rays; 0 where all or nothing of each emitter is seen
};

/// Direct light from all that emits on a mesh, whatever its size:
///
///     E(x) = Σ_e F(x, e) V̄ B_e
///
/// over the terminals e of EmitterTree::cut. F is in closed form, of those as good as points A cosθ cosθ' / (π d²); V̄ is the visible
/// share by shadow rays, shared among the terminals in proportion to F B_e: exact where all or nothing of an emitter is seen. Emitters
/// shine as finely as they are given (source polygons; of textured ones the patches), on receivers they never touch from behind.
///
/// Closed form times visibility: D. R. Baum, H. E. Rushmeier, J. M. Winget, "Improving radiosity solutions through the use of
/// analytically determined form-factors", SIGGRAPH 1989.
class EmitterLight {
public:
    /// `rays`, of the scene of `mesh`, must outlive it; `mesh` and `optics` need not.
    EmitterLight(const RayCaster& rays, const PatchMesh& mesh, const PatchOptics& optics, std::uint64_t seed);

    bool empty() const { return tree_.triangles().empty(); } //!< nothing emits
    /// The materials that emit, into Scene::materials, ascending.
    std::span<const std::uint32_t> materials() const { return tree_.groups(); }

    /// The mean over each patch, #patches: over 16 points with 16 rays each, and up to 4 times as many where they differ and the
    /// patches are no more than 30,000. If `byMaterial` is given, it becomes #materials × #patches: what comes from each; they add up
    /// to the result. The same whatever the number of threads. Throws Cancelled.
    std::vector<RgbSum> irradiance(const PatchMesh& mesh, Progress& progress,
                                   std::vector<std::vector<RgbSum>>* byMaterial = nullptr) const;

    /// At a point (metres) of a surface with this unit normal, by about so many rays (64 at least), which begin `lift` metres above
    /// it. Points of different `index` have rays of their own, as have rounds of one point. Thread-safe.
    EstimatedLight irradiance(const glm::vec3& point, const glm::vec3& normal, float lift, std::uint32_t index,
                              std::uint32_t rays, std::uint32_t round = 0) const;

private:
    const RayCaster& rays_;
    std::uint64_t seed_;
    EmitterTree tree_;
};

} // namespace lambert
