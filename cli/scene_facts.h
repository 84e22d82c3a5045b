#pragma once

#include "lighting/lost_light.h"
#include "meshing/back_faces.h"
#include "meshing/prepare.h"
#include "meshing/surface_check.h"
#include "scene/reading.h"
#include "scene/unit_guess.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace lambert {

/// What is worth knowing of a scene before it is baked.
struct SceneFacts {
    Bounds bounds;
    std::size_t triangles = 0, quads = 0;
    std::size_t slivers = 0; //!< height below 1e-4 of the longest edge
    double area = 0.0;       //!< m²
    glm::dvec3 emitted{0.0}; //!< watts or lumens, fronts and second sides

    struct Part {
        std::size_t polygons = 0;
        double area = 0.0; //!< m²
    };
    std::vector<Part> materials; //!< #materials
    std::vector<Part> nodes;     //!< #nodes

    PrepareReport prepared;
    SurfaceCheck surfaces;
    BackFaceSample backs, backsFromLights;
    std::vector<LostLight> lostLight; //!< lights that light nothing
    std::vector<LengthUnit> units;    //!< guesses other than the unit in force, see guessUnits
};

/// Looks at a scene as it was read; prepares it, checks its surfaces and shoots some rays. Throws Cancelled.
SceneFacts gatherFacts(const Scene& scene, Progress& progress);

/// Something worth a look: what it is, and which option or which change of the file mends it.
struct Finding {
    std::string problem, remedy;
};
std::vector<Finding> worthALook(const ReadResult& read, const SceneFacts& facts, bool unitIsGiven);

} // namespace lambert
