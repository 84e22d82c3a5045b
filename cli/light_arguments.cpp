#include "cli/light_arguments.h"
#include "cli/arguments.h"
#include "cli/validators.h"

#include "core/error.h"
#include "scene/environment.h"
#include "scene/sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace lambert {

namespace {

constexpr double kMostLight = 1e30;
/// Of an overcast sky of which no sun tells how bright it is: a daylight factor of 1 % is then 100 lx.
constexpr double kOvercastIlluminance = 10000.0;

bool areLight(const std::vector<double>& values, std::size_t from) {
    return std::all_of(values.begin() + static_cast<std::ptrdiff_t>(from), values.end(),
                       [](double v) { return v >= 0.0 && v <= kMostLight; });
}

enum class SkyKind { Dark, Clear, Overcast, Constant, Picture };

SkyKind kindOf(const std::string& sky) {
    if (sky.empty()) return SkyKind::Dark;
    if (sky == "clear") return SkyKind::Clear;
    if (sky == "overcast") return SkyKind::Overcast;
    return numbersOf(sky) ? SkyKind::Constant : SkyKind::Picture;
}

Rgb constantSky(const std::string& text) {
    const auto values = numbersOf(text).value();
    if (values.size() != 3 || !areLight(values, 0))
        throw UsageError(fmt::format("--sky: found \"{}\", allowed are three numbers r,g,b from 0 to {:g}, clear, "
                                     "overcast, or a picture's name",
                                     text, kMostLight));
    return Rgb(glm::dvec3(values[0], values[1], values[2]));
}

struct Sun {
    double azimuth = 0.0, elevation = 0.0; ///< degrees
    std::optional<glm::dvec3> illuminance; ///< lx, where it is given
};

Sun parseSun(const std::string& text) {
    const auto values = numbersOf(text);
    const std::size_t count = values ? values->size() : 0;
    if (count != 2 && count != 3 && count != 5)
        throw UsageError(
            fmt::format("--sun: found \"{}\", expected AZIMUTH,ELEVATION in degrees, and its illuminance as "
                        "one number or r,g,b if not by a clear sky, as in 135,35 or 135,35,80000",
                        text));
    const Sun sun{(*values)[0], (*values)[1],
                  count == 3   ? std::optional(glm::dvec3((*values)[2]))
                  : count == 5 ? std::optional(glm::dvec3((*values)[2], (*values)[3], (*values)[4]))
                               : std::nullopt};
    if (std::abs(sun.azimuth) > 360.0 || sun.elevation < 0.0 || sun.elevation > 90.0 || !areLight(*values, 2))
        throw UsageError(
            fmt::format("--sun: found \"{}\", allowed are azimuths from -360 to 360, elevations from 0 to 90 "
                        "degrees, and illuminances from 0 to {:g}",
                        text, kMostLight));
    return sun;
}

/// `sun` counts if it is given, and always under a clear sky.
std::shared_ptr<const Environment> skyOf(const LightArguments& a, const Sun& sun) {
    const auto shared = [](Environment sky) { return std::make_shared<const Environment>(std::move(sky)); };
    switch (kindOf(a.sky)) {
    case SkyKind::Dark:
        return nullptr;
    case SkyKind::Clear:
        return shared(clearSky(sun.azimuth, sun.elevation));
    case SkyKind::Overcast:
        return shared(overcastSky(a.sun.empty() ? kOvercastIlluminance : overcastSkyIlluminance(sun.elevation)));
    case SkyKind::Constant:
        return shared(Environment::constant(constantSky(a.sky)));
    case SkyKind::Picture:
        return shared(readEnvironment(a.sky));
    }
    return nullptr; // not reached
}

} // namespace

void addLightArguments(CLI::App& command, LightArguments& a) {
    command.option_defaults()->group("Light");
    command
        .add_option(
            "--sky", a.sky,
            "What the scene lies in: radiance r,g,b from all around; clear (CIE, with --sun); overcast (CIE); or a "
            "latitude-longitude picture, north (-Z) in its middle [darkness]")
        ->type_name("FILE|r,g,b|clear|overcast");
    command
        .add_option("--sun", a.sun,
                    "Where the sun stands: degrees clockwise from north (-Z; east is +X), and above the horizon; "
                    "optionally its illuminance, lx [that under a clear sky; none under an overcast one]")
        ->type_name("AZIMUTH,ELEVATION[,LUX]");
    addNumber(command, "--light-points", a.points,
              "Points of a patch from which each light without area is looked for [256]", "N", 1, 65536);
    addNumber(command, "--sky-rays", a.skyRays,
              "Rays of a patch to the sky [4096; 512 and 16384 with --quality preview and high]", "N", 2, 16777216);
}

void checkLights(const LightArguments& a) {
    const SkyKind kind = kindOf(a.sky);
    if (kind == SkyKind::Constant) constantSky(a.sky);
    if (kind == SkyKind::Clear && a.sun.empty())
        throw UsageError("--sky clear: is brightest around the sun; give --sun AZIMUTH,ELEVATION");
    if (!a.sun.empty()) parseSun(a.sun);
}

std::filesystem::path skyPicture(const LightArguments& a) {
    return kindOf(a.sky) == SkyKind::Picture ? std::filesystem::path(a.sky) : std::filesystem::path();
}

void addDaylight(Scene& scene, const LightArguments& a) {
    checkLights(a);
    const Sun sun = a.sun.empty() ? Sun{} : parseSun(a.sun);
    scene.environment = skyOf(a, sun);
    if (scene.environment && scene.environment->isDark()) scene.environment = nullptr;
    if (a.sun.empty() || (kindOf(a.sky) == SkyKind::Overcast && !sun.illuminance)) return;
    PunctualLight light;
    light.name = "sun";
    light.kind = PunctualLight::Kind::Directional;
    light.direction = glm::vec3(-skyDirection(sun.azimuth, sun.elevation));
    light.intensity = Rgb(sun.illuminance.value_or(glm::dvec3(sunIlluminance(sun.elevation))));
    scene.lights.push_back(std::move(light));
}

nlohmann::ordered_json lightOptionsJson(const LightArguments& a, const DirectLightOptions& direct) {
    using Json = nlohmann::ordered_json;
    return {{"sky", a.sky.empty() ? Json(nullptr) : Json(a.sky)},
            {"sun", a.sun.empty() ? Json(nullptr) : Json(a.sun)},
            {"light_points", direct.points},
            {"sky_rays", direct.skyRays}};
}

} // namespace lambert
