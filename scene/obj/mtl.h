#pragma once

#include "scene/obj/lines.h"
#include "scene/scene.h"

#include <glm/vec2.hpp>

#include <optional>
#include <string>
#include <vector>

namespace lambert {

/// A `map_…` statement. Looked up at scale · (u, v) + offset, v upwards; value = base + gain · the image's.
struct MtlMap {
    std::string file; //!< as written
    glm::vec2 scale{1.0F};
    glm::vec2 offset{0.0F};
    bool clamp = false;
    float base = 0.0F;
    float gain = 1.0F;
};

/// What Lambert uses of a `newmtl`, and of the rest what tells that a material is more than diffuse.
struct MtlMaterial {
    std::string name;              //!< in UTF-8
    std::optional<Rgb> diffuse{};  //!< Kd, finite
    std::optional<Rgb> emission{}; //!< Ke, finite
    std::optional<MtlMap> diffuseMap{}, emissionMap{}, opacityMap{};
    Rgb specular{0.0F};   //!< Ks
    float opacity = 1.0F; //!< d, or without it 1 - Tr
    int illumination = 2; //!< illum: from 3 on a mirror, glass or both
};

struct MtlFile {
    std::vector<MtlMaterial> materials; //!< in the file's order; names may repeat
    std::vector<std::string> warnings;  //!< one line each, without the file's name
};

/// Reads a material library. Throws InputError, with file, line, what was found and what is expected, if a statement that
/// counts is malformed.
MtlFile readMtl(ObjLines& lines);

} // namespace lambert
