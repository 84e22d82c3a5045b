#include "cli/scene_arguments.h"
#include "cli/validators.h"

#include "cli/arguments.h"

#include "core/error.h"
#include "scene/reading/changed_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

constexpr float kLargestRadiance = 1e30F;
constexpr float kLargestReflectance = 0.99F;

struct NamedColour {
    std::string name;
    Rgb colour;
};

/// NAME=r,g,b; a name may hold "=". Throws UsageError.
NamedColour parseNamedColour(const std::string& setting, const std::string& option, float largest) {
    const std::size_t separator = setting.rfind('=');
    if (separator == std::string::npos)
        throw UsageError(fmt::format("{}: found \"{}\", expected MATERIAL=r,g,b", option, setting));
    const Rgb value(parseVector(setting.substr(separator + 1), option));
    if (std::min({value.x, value.y, value.z}) < 0.0F || std::max({value.x, value.y, value.z}) > largest)
        throw UsageError(fmt::format("{}: found \"{}\", allowed are values from 0 to {:g}", option, setting, largest));
    return {setting.substr(0, separator), value};
}

/// What the options ask for. Throws UsageError.
SceneOverrides typedOverrides(const SceneArguments& a) {
    SceneOverrides result;
    for (const std::string& setting : a.emit) {
        const NamedColour named = parseNamedColour(setting, "--emit", kLargestRadiance);
        result.materials.push_back({named.name, {"--emit"}, named.colour, std::nullopt, std::nullopt});
    }
    for (const std::string& setting : a.reflectance) {
        const NamedColour named = parseNamedColour(setting, "--reflectance", kLargestReflectance);
        result.materials.push_back({named.name, {"--reflectance"}, std::nullopt, named.colour, std::nullopt});
    }
    // The last one counts: what is excluded is not there.
    for (const std::string& name : a.occludeOnly)
        result.nodes.push_back({name, {"--occlude-only"}, NodeOverride::Treatment::OccludeOnly});
    for (const std::string& name : a.exclude)
        result.nodes.push_back({name, {"--exclude"}, NodeOverride::Treatment::Exclude});
    return result;
}

SceneChanges changesOf(const SceneArguments& a) {
    return {a.overrides, a.noOverrides, a.unit, a.twoSided, typedOverrides(a)};
}

} // namespace

void addSceneArguments(CLI::App& command, SceneArguments& a) {
    command.add_option("scene", a.path, "Scene: " + sceneExtensions())->required()->type_name("SCENE");
    addSceneOptions(command, a);
}

void addSceneOptions(CLI::App& command, SceneArguments& a) {
    command.option_defaults()->group("Scene");
    command.add_option("--unit", a.unit, "Metres per unit of the file (not of glTF, which is in metres) [1]")
        ->type_name("METRES");
    command.add_flag("--two-sided", a.twoSided, "Every surface reflects and emits on both sides");
    addNumber(command, "--curve-segments", a.curveSegments,
              "Straight pieces that a circle of an MGF scene becomes, even, 4 to 1024 [24]", "N", 4.0, 1024.0);
    addNumber(command, "--most-polygons", a.mostPolygons,
              "Refuses scenes with more; 0: a million and one for each byte of the file [0]", "N", 0.0, 4e9);
    const auto addList = [&](const char* name, std::vector<std::string>& list, const char* text, const char* type) {
        command.add_option(name, list, text)->type_name(type)->allow_extra_args(false);
    };
    addList("--emit", a.emit, "Emitted radiance L_e of a material, per m² and sr; * in a name: any characters",
            "MATERIAL=r,g,b");
    addList("--reflectance", a.reflectance, "Diffuse reflectance of a material, 0 to 0.99", "MATERIAL=r,g,b");
    addList("--exclude", a.exclude, "Leaves a node's polygons out", "NODE");
    addList("--occlude-only", a.occludeOnly, "A node's polygons only block light and are not in the result", "NODE");
    auto* overrides =
        command
            .add_option("--overrides", a.overrides, "Such changes as JSON [SCENE's name.lambert.json, if it is there]")
            ->type_name("FILE");
    command.add_flag("--no-overrides", a.noOverrides, "Does not look for that file")->excludes(overrides);
    command.add_flag("--strict", a.strict, "A missing image and the like is an error, not a warning");
    command.add_flag("--allow-outside-files", a.allowOutsideFiles, "The scene may name files outside its own folder");
}

bool unitIsGiven(const SceneArguments& a, const AppliedOverrides& overrides) {
    return a.unit || overrides.metresPerUnit != 1.0 || isInMetres(a.path);
}

ReadResult readScene(const SceneArguments& a, Progress* progress) {
    if (a.unit && !(*a.unit > 0.0 && std::isfinite(*a.unit)))
        throw UsageError(fmt::format("--unit: found {}, allowed is a number above 0", *a.unit));
    return readChangedScene(a.path, changesOf(a),
                            {.strict = a.strict,
                             .allowOutsideFiles = a.allowOutsideFiles,
                             .progress = progress,
                             .curveSegments = a.curveSegments,
                             .mostPolygons = a.mostPolygons});
}

} // namespace lambert
