#pragma once

#include "meshing/coplanar_cover.h"
#include "scene/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace lambert {

/// Which faces of one plane overlap and which of them shows, the largest overlaps by name; one line. Empty if there are none.
std::string overlapText(const Scene& scene, const CoverReport& report);

/// The same as a list of {`upper`, `lower`: {`node`, `material`}, `area`}.
nlohmann::ordered_json overlapsJson(const Scene& scene, const CoverReport& report);

} // namespace lambert
