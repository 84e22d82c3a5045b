#pragma once

#include "solver/direct_light.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace lambert {

/// The light that comes from outside the scene, and how lights without area are sampled.
struct LightArguments {
    std::string sky; //!< clear, overcast, r,g,b or a picture's name; empty: darkness
    std::string sun; //!< AZIMUTH,ELEVATION, and its illuminance as one number or three; empty: none
    std::uint32_t points = DirectLightOptions{}.points;
    std::optional<std::uint32_t> skyRays;
};

void addLightArguments(CLI::App& command, LightArguments& arguments);

/// Throws UsageError for what can be known to be wrong before a file is read.
void checkLights(const LightArguments& arguments);

/// The picture of the sky; empty if there is none.
std::filesystem::path skyPicture(const LightArguments& arguments);

/// Puts sky and sun into a scene. Throws UsageError as above, InputError if the picture cannot be read.
void addDaylight(Scene& scene, const LightArguments& arguments);

/// `direct`: in force.
nlohmann::ordered_json lightOptionsJson(const LightArguments& arguments, const DirectLightOptions& direct);

} // namespace lambert
