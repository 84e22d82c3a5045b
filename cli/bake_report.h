#pragma once

#include "baking/bake_scene.h"
#include "cli/arguments.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <vector>

namespace lambert {

/// Area-weighted means over one material. A face counts once, whatever its number of sides; the irradiance of a
/// two-sided face is the flux on both sides divided by that area. What is covered by others in its plane counts, and receives nothing.
struct MaterialLight {
    std::string name;
    double area = 0.0; //!< m²
    RgbSum meanIrradiance{0.0}, meanRadiosity{0.0};
};

/// The name of the method that the light was found by; "file" if form factors were read, "none" if there was no light to follow.
std::string methodName(const LightMethod& method, const SolvedScene& solved);
/// That of the solver; "none" for instant radiosity.
std::string solverName(const LightMethod& method);

/// One entry per material that is used, in the scene's order.
std::vector<MaterialLight> materialLight(const SolvedScene& solved);

/// What the JSON report of a solved scene is made of.
struct BakeReportInput {
    const SolvedScene& solved;
    const SolveOptions& options;
    const ReadReport& read;
    const SceneArguments& scene;
    const TransportArguments& transport;
    const RunArguments& run;
    double readSeconds = 0.0, writeSeconds = 0.0, totalSeconds = 0.0;
    const BakedScene* baked = nullptr; //!< null: nothing was baked
    std::optional<Picture> picture{};
    std::optional<double> exposure{}; //!< EV; none where nothing is shown
};

/// How the scene was read and what was changed of it, by options or by the overrides file.
nlohmann::ordered_json sceneOptionsJson(const SceneArguments& scene, const AppliedOverrides& overrides);

/// Of what finds the light: form factors, lines or virtual point lights.
nlohmann::ordered_json methodOptionsJson(const LightMethod& method, const std::optional<TransportPlan>& plan);

/// The report of one bake or solve; keys are documented in docs/output.md.
nlohmann::ordered_json bakeReport(const BakeReportInput& input);

nlohmann::ordered_json energyJson(const EnergyBalance& energy);

/// A report as text.
std::string jsonText(const nlohmann::ordered_json& json);

/// Writes a report to a file, whole.
void writeJson(const nlohmann::ordered_json& json, const std::filesystem::path& path);

/// [r, g, b]
nlohmann::ordered_json jsonVector(const glm::dvec3& v);

} // namespace lambert
