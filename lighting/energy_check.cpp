#include "lighting/energy_check.h"

#include "lighting/factor_diagnosis.h"
#include "lighting/solve_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

double lightThatCameIn(const EnergyBalance& energy) { return sumOf(energy.emitted + energy.received); }

/// What is lost of the light of each material.
std::vector<double> lostByMaterial(const SolvedScene& solved, std::span<const double> deficit) {
    std::vector<double> lost(solved.scene->materials.size(), 0.0);
    const bool emittersApart = !solved.emittersIrradiance.empty();
    for (std::size_t j = 0; j < deficit.size(); ++j) {
        const RgbSum emitted(emittersApart ? solved.optics.emittedRadiosity[j] : Rgb(0.0F));
        lost[solved.mesh.material[j]] += deficit[j] * sumOf(solved.solution.radiosity[j] - emitted);
    }
    return lost;
}

/// "the rays lose 3.0 % of the light"
std::string lossText(const char* what, double imbalance) {
    return fmt::format("{} {} {:.1f} % {} the light", what, imbalance > 0.0 ? "lose" : "add",
                       100.0 * std::abs(imbalance), imbalance > 0.0 ? "of" : "to");
}

std::string lossText(const SolvedScene& solved, const LightMethod& method) {
    const EnergyCheck& check = solved.energyCheck;
    if (solved.instantRadiosity()) return lossText("the virtual point lights", check.judged) + "; try more --vpls";
    if (const FormFactorsUsed* used = solved.formFactors()) {
        std::string text = lossText("the form factors", check.judged);
        if (std::get<FormFactorLight>(method).formFactors.repair) text += " before repair";
        if (check.beforeRepair)
            text += fmt::format(", mostly {}that of \"{}\"", check.judged > 0.0 ? "" : "to ", check.material);
        return text + ": " + causeAndRemedy(used->plan, true);
    }
    const bool byChance = std::abs(check.judged) < 3.0 * check.judgedError;
    return fmt::format("{} (± {:.1f} %){}", lossText("the rays", check.judged), 100.0 * check.judgedError,
                       byChance ? ", by chance; try more --rays or a smaller --target-error"
                                : ": faces cross, or do not quite meet; `lambert info` tells where to look");
}

} // namespace

double lossOfEmitters(const SolvedScene& solved, const FormFactorMatrix& matrix) {
    double lost = 0.0;
    for (std::size_t i = 0; i < solved.emittersIrradiance.size(); ++i)
        lost += static_cast<double>(solved.mesh.area[i]) *
                (sumOf(RgbSum(solved.optics.emittedRadiosity[i])) * (1.0 - matrix.back(i) - matrix.out(i)) -
                 sumOf(solved.emittersIrradiance[i]));
    return lost;
}

EnergyCheck checkEnergy(const SolvedScene& solved, std::span<const double> deficit, double lostByEmitters) {
    const EnergyBalance& energy = solved.solution.energy;
    const double in = lightThatCameIn(energy);
    EnergyCheck check;
    if (!(in > 0.0)) return check;
    if (!deficit.empty()) {
        const std::vector<double> lost = lostByMaterial(solved, deficit);
        double sum = lostByEmitters;
        for (const double l : lost) sum += l;
        check.beforeRepair = check.judged = sum / in;
        const auto most = sum > 0.0 ? std::ranges::max_element(lost) : std::ranges::min_element(lost);
        check.material = solved.scene->materials[static_cast<std::size_t>(most - lost.begin())].name;
    } else if (const InstantRadiosity* lights = solved.instantRadiosity()) {
        check.judged = energy.imbalance() - sumOf(lights->lost) / in;
    } else {
        check.judged = energy.imbalance();
        if (const StochasticSolution* lines = solved.stochastic()) check.judgedError = lines->imbalanceError;
    }
    return check;
}

std::vector<std::string> energyWarnings(const SolvedScene& solved, const LightMethod& method) {
    std::vector<std::string> warnings;
    const EnergyCheck& check = solved.energyCheck;
    if (std::abs(check.judged) > kImbalanceTold) {
        warnings.push_back(lossText(solved, method));
        if (check.missed())
            warnings.back() += fmt::format(" (exit code 1, as this is above {:g} %)", 100.0 * kImbalanceMissed);
    }
    if (const FormFactorsUsed* used = solved.formFactors(); used != nullptr && used->repair)
        for (std::string& text : repairWarnings(used->plan, *used->repair)) warnings.push_back(std::move(text));
    return warnings;
}

} // namespace lambert
