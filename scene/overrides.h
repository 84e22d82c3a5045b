#pragma once

#include "scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace lambert {

/// Who asks for a change: what a message begins with, and whose error it is if it cannot be made.
struct OverrideSource {
    std::string place;   //!< an option, or a file and the JSON path in it
    bool inFile = false; //!< InputError rather than UsageError
};

/// What a material shall be instead of what the scene's file says.
struct MaterialOverride {
    std::string name; //!< of the material; a * stands for any characters, see matchingNames
    OverrideSource source;
    std::optional<Rgb> emittedRadiance; //!< L_e per m² and sr, >= 0; in place of constant and texture
    std::optional<Rgb> reflectance;     //!< 0 to 0.99; in place of constant, texture and tint; holes stay
    std::optional<bool> twoSided;
};

/// What shall become of the polygons of a node.
struct NodeOverride {
    enum class Treatment {
        Exclude,    //!< they are not there
        OccludeOnly //!< they only block light, see Material::occluder
    };
    std::string name; //!< of the node; a * stands for any characters, see matchingNames
    OverrideSource source;
    Treatment treatment = Treatment::Exclude;
};

/// What a user changes of a scene without touching its file. Of several that name the same thing the last one counts.
struct SceneOverrides {
    std::vector<MaterialOverride> materials;
    std::vector<NodeOverride> nodes;
};

/// Makes the changes. Throws UsageError or InputError, by their source, if a name is not in the scene or if no polygon is
/// left to be lit.
void applyOverrides(Scene& scene, const SceneOverrides& overrides);

} // namespace lambert
