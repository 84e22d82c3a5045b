#pragma once

#include "meshing/patch_optics.h"
#include "solver/solution.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// What is given of patches, #patches each. Whoever fills it in keeps the arrays.
struct PatchViews {
    std::span<const float> area;           //!< m²
    std::span<const Rgb> reflectance;      //!< ρ, 0 to 0.99
    std::span<const Rgb> emittedRadiosity; //!< B_e, per m²
    // Instead of both where single precision is too little, as of polished metal: one channel, ρ from 0 to 1.
    std::span<const double> greyReflectance{}, greyEmitted{};

    PatchViews(std::span<const float> patchArea, const PatchOptics& optics)
        : area(patchArea), reflectance(optics.reflectance), emittedRadiosity(optics.emittedRadiosity) {}
    PatchViews(const PatchMesh& mesh, const PatchOptics& optics) : PatchViews(std::span(mesh.area), optics) {}
    PatchViews(std::span<const float> patchArea, std::span<const double> reflected, std::span<const double> emitted)
        : area(patchArea), greyReflectance(reflected), greyEmitted(emitted) {}
};

/// What is to be solved, but for the form factors, for every patch i and channel:
///
///     B_i = B_e,i + ρ_i E_i,   E_i = E_0,i + Σ_j F_ij B_j
///
/// The light of what emits may be found beforehand, apart from the form factors. E_0 then holds it, and B_e is 0 for the solver; once
/// it has ended, settle() adds what was left out.
class SolverProblem {
public:
    /// `patches` must outlive the problem. `directIrradiance` is E_0 per m², from lights without area: #patches, or empty where
    /// there are none. `emittersIrradiance`: the same of all that emits; empty: left to the form factors. Throws
    /// InputError if nothing emits and nothing is lit.
    explicit SolverProblem(const PatchViews& patches, std::vector<RgbSum> directIrradiance = {},
                           const std::vector<RgbSum>& emittersIrradiance = {});

    std::size_t size() const { return patches_.area.size(); } //!< #patches
    const PatchViews& patches() const { return patches_; }

    double area(std::size_t i) const { return static_cast<double>(patches_.area[i]); } //!< A, m²
    RgbSum reflectance(std::size_t i) const {                                          //!< ρ
        return isGrey() ? RgbSum(patches_.greyReflectance[i]) : RgbSum(patches_.reflectance[i]);
    }
    /// B_e, as far as form factors carry it.
    RgbSum emitted(std::size_t i) const { return emittersApart_ ? RgbSum(0.0) : allEmitted(i); }
    RgbSum direct(std::size_t i) const { return direct_.empty() ? RgbSum(0.0) : direct_[i]; }          //!< E_0
    RgbSum source(std::size_t i) const { return emitted(i) + reflectance(i) * direct(i); }             //!< B_e + ρ E_0
    RgbSum radiosity(std::size_t i, const RgbSum& e) const { return emitted(i) + reflectance(i) * e; } //!< B_e + ρ E

    /// B_e, whatever carries it.
    RgbSum allEmitted(std::size_t i) const {
        return isGrey() ? RgbSum(patches_.greyEmitted[i]) : RgbSum(patches_.emittedRadiosity[i]);
    }
    /// Σ A E_0 of lights without area alone.
    const RgbSum& received() const { return received_; }
    bool emittersApart() const { return emittersApart_; } //!< E_0 holds their light

    std::vector<RgbSum> emitted() const; //!< #patches, B_e
    /// #patches: B_e + ρ E for irradiances E to begin from, B_e if there are none.
    std::vector<RgbSum> startRadiosity(std::span<const RgbSum> start) const;

    /// sqrt(Σ A |value|²) over patches and channels, divided by that of B_e + ρ E_0.
    double relativeNorm(std::span<const RgbSum> values) const;
    /// The same from the sum of squares.
    double relativeNorm(double sumOfSquares) const;

    /// A check sum of all of this, unless it is grey.
    std::uint64_t checksum() const;

private:
    double sumOfSquares(std::span<const RgbSum> values) const;
    bool isGrey() const { return !patches_.greyReflectance.empty(); }

    PatchViews patches_;
    std::vector<RgbSum> direct_;
    bool emittersApart_ = false;
    RgbSum received_{0.0};
    double sourceNorm_ = 0.0;
};

} // namespace lambert
