#include "baking/energy_check.h"

#include "baking/bake_scene.h"
#include "baking/factor_diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

double sumOf(const RgbSum& c) { return c.x + c.y + c.z; }

double lightThatCameIn(const EnergyBalance& energy) { return sumOf(energy.emitted + energy.received); }

/// What is lost of the light of each material.
std::vector<double> lostByMaterial(const BakedScene& baked, std::span<const double> deficit) {
    std::vector<double> lost(baked.scene->materials.size(), 0.0);
    const bool emittersApart = !baked.emittersIrradiance.empty();
    for (std::size_t j = 0; j < deficit.size(); ++j) {
        const RgbSum emitted(emittersApart ? baked.mesh.emittedRadiosity[j] : Rgb(0.0F));
        lost[baked.mesh.material[j]] += deficit[j] * sumOf(baked.solution.radiosity[j] - emitted);
    }
    return lost;
}

/// "the rays lose 3.0 % of the light"
std::string lossText(const char* what, double imbalance) {
    return fmt::format("{} {} {:.1f} % {} the light", what, imbalance > 0.0 ? "lose" : "add",
                       100.0 * std::abs(imbalance), imbalance > 0.0 ? "of" : "to");
}

std::string lossText(const BakedScene& baked, bool repaired) {
    const EnergyCheck& check = baked.energyCheck;
    if (baked.instantRadiosity) return lossText("the virtual point lights", check.judged) + "; try more --vpls";
    if (!baked.stochastic) {
        std::string text = lossText("the form factors", check.judged);
        if (repaired) text += " before repair";
        if (check.beforeRepair)
            text += fmt::format(", mostly {}that of \"{}\"", check.judged > 0.0 ? "" : "to ", check.material);
        return text + ": " + causeAndRemedy(baked.plan, true);
    }
    const bool byChance = std::abs(check.judged) < 3.0 * check.judgedError;
    return fmt::format("{} (± {:.1f} %){}", lossText("the rays", check.judged), 100.0 * check.judgedError,
                       byChance ? ", by chance; try more --rays or a smaller --target-error"
                                : ": faces cross, or do not quite meet; `lambert info` tells where to look");
}

} // namespace

double lossOfEmitters(const BakedScene& baked, const FormFactorMatrix& matrix) {
    double lost = 0.0;
    for (std::size_t i = 0; i < baked.emittersIrradiance.size(); ++i)
        lost += static_cast<double>(baked.mesh.area[i]) *
                (sumOf(RgbSum(baked.mesh.emittedRadiosity[i])) * (1.0 - matrix.back(i) - matrix.out(i)) -
                 sumOf(baked.emittersIrradiance[i]));
    return lost;
}

EnergyCheck checkEnergy(const BakedScene& baked, const BakeOptions& options, std::span<const double> deficit,
                        double lostByEmitters) {
    const EnergyBalance& energy = baked.solution.energy;
    const double in = lightThatCameIn(energy);
    EnergyCheck check;
    if (!(in > 0.0)) return check;
    if (!deficit.empty()) {
        const std::vector<double> lost = lostByMaterial(baked, deficit);
        double sum = lostByEmitters;
        for (const double l : lost) sum += l;
        check.beforeRepair = check.judged = sum / in;
        const auto most = sum > 0.0 ? std::ranges::max_element(lost) : std::ranges::min_element(lost);
        check.material = baked.scene->materials[static_cast<std::size_t>(most - lost.begin())].name;
    } else if (baked.instantRadiosity) {
        check.judged = energy.imbalance() - sumOf(baked.instantRadiosity->lost) / in;
    } else if (baked.stochastic) {
        check.judged = energy.imbalance();
        check.judgedError = baked.stochastic->imbalanceError;
    } else if (options.solver.bounces == 0) {
        check.judged = energy.imbalance();
    }
    return check;
}

std::vector<std::string> energyWarnings(const BakedScene& baked, const BakeOptions& options) {
    std::vector<std::string> warnings;
    const EnergyCheck& check = baked.energyCheck;
    if (std::abs(check.judged) > kImbalanceTold) {
        warnings.push_back(lossText(baked, options.formFactors.repair));
        if (check.missed())
            warnings.back() += fmt::format(" (exit code 1, as this is above {:g} %)", 100.0 * kImbalanceMissed);
    }
    if (baked.repair)
        for (std::string& text : repairWarnings(baked.plan, *baked.repair)) warnings.push_back(std::move(text));
    return warnings;
}

} // namespace lambert
