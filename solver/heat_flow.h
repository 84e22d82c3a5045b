#pragma once

#include "core/progress.h"
#include "formfactors/form_factor_matrix.h"
#include "formfactors/group_factors.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lambert {

inline constexpr double kStefanBoltzmann = 5.670374419e-8; ///< W m⁻² K⁻⁴, CODATA 2018 (exact)

/// The surface of a group of patches in thermal radiation: grey and diffuse.
struct ThermalSurface {
    std::optional<double> kelvin; //!< >= 0; none: adiabatic, every patch gives off as much as it receives
    double emissivity = 1.0;      //!< 0 to 1; of an adiabatic surface it does not matter
};

struct HeatFlowOptions {
    double environment = 0.0; //!< kelvin, of black surroundings beyond all openings
    double tolerance = 1e-10; //!< of the residual, relative
};

struct HeatFlow {
    std::vector<double> radiosity;  //!< #patches, J, W/m²
    std::vector<double> irradiance; //!< #patches, G, W/m²
    std::vector<double> flow;     //!< #groups, Σ A (J − G), W: above 0 where a group gives off more than it receives
    std::vector<double> kelvin;   //!< #groups: as given; of an adiabatic one that of its mean J
    double environmentFlow = 0.0; //!< W, what the environment gives off less what it receives
    double backFlow = 0.0;        //!< W, the same of black backs and of patches without group; they give off nothing
    std::int64_t iterations = 0;
    double residual = 0.0;

    /// Σ of all flows, W; 0 for exact form factors.
    double imbalance() const;
};

/// Radiative exchange in an enclosure of grey, diffuse, isothermal-by-patch surfaces:
///
///     J = ε σ T⁴ + (1 − ε) G,   G = F J + F_out σ T_env⁴
///
/// solved for J as light is, by solveConjugateGradient. `area` (m²) and `group` (into `surfaces`, or kNoGroup: black, gives off
/// nothing, counted with the backs): #patches. Throws InputError if nothing has a temperature, Cancelled. A residual above the
/// tolerance is not an error.
HeatFlow solveHeatFlow(const FormFactorMatrix& matrix, std::span<const float> area,
                       std::span<const std::uint32_t> group, std::span<const ThermalSurface> surfaces,
                       const HeatFlowOptions& options, Progress& progress);

} // namespace lambert
