#pragma once

#include "scene/scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace lambert {

/// Every term of the energy balance is computed from its own definition, none from the others (watts or lumens,
/// as the emission is given).
struct EnergyBalance {
    RgbSum emitted{0.0};   //!< Σ A B_e
    RgbSum received{0.0};  //!< Σ A E_0, from lights without area
    RgbSum absorbed{0.0};  //!< Σ A (1−ρ) E
    RgbSum backFaces{0.0}; //!< Σ A B F_back
    RgbSum escaped{0.0};   //!< Σ A B F_out

    /// (emitted + received − absorbed − backFaces − escaped) / (emitted + received), summed over the channels.
    double imbalance() const;
};

struct SolverStep {
    std::int64_t iteration = 0; //!< of Southwell's method: patches shot
    double residual = 0.0;      //!< relative, area-weighted
    double seconds = 0.0;       //!< since the solver's start
};

/// The light on every patch.
struct RadiositySolution {
    std::vector<RgbSum> radiosity;  //!< #patches, B per m²
    std::vector<RgbSum> irradiance; //!< #patches, E per m²
    std::vector<float> covered;     //!< #patches, F_back: near 1 for a patch inside another object
    EnergyBalance energy;
    std::vector<SolverStep> history;
    /// #bounces × #patches: radiosity that each added to B_e; [0] is light that was reflected once. Empty unless kept.
    std::vector<std::vector<Rgb>> bounces;
    std::int64_t iterations = 0; //!< of Southwell's method: patches shot
    /// ‖B_e + ρ(E_0 + F B) − B‖ / ‖B_e + ρE_0‖ of the last iterate, area-weighted. `radiosity` is one bounce further.
    double residual = 0.0;
};

} // namespace lambert
