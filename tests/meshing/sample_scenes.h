#pragma once

#include "meshing/build_patch_mesh.h"
#include "scene/scene.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <vector>

namespace lambert {

/// A prepared scene with a name for test output.
struct SampleScene {
    std::string name;
    Scene scene;
    bool closed = false; ///< every edge belongs to exactly two polygons
};

inline void PrintTo(const SampleScene& sample, std::ostream* out) { *out << sample.name; }

/// A polygon in the plane z = 0, turned about no special axis and moved.
Scene flatScene(std::span<const glm::vec2> corners);

/// The same, turned about no special axis and moved.
Scene turned(Scene scene);
Scene scaled(Scene scene, float factor);

/// Adds the faces of an axis-parallel box, seen from outside, as a node of its own; without its bottom (z =
/// lower.z) if it only stands there.
void addBox(Scene& scene, const glm::vec3& lower, const glm::vec3& upper, bool withBottom);

/// A grey one-sided polygon with vertices of its own.
void addPolygon(Scene& scene, std::span<const glm::vec3> corners);
Scene emptyScene();

/// A closed room with a box on its floor that is turned against the walls; prepared.
Scene roomWithTurnedBox();

/// A convex quad with corners at random angles on a random ellipse.
std::vector<glm::vec2> randomConvexQuad(std::uint32_t seed);

/// A scene from the data folder, prepared.
Scene dataScene(const std::string& file);

/// Shapes in all variants, prepared.
std::vector<SampleScene> sampleScenes();

PatchMesh meshWithLength(const Scene& scene, double patchLength, MeshReport* report = nullptr);

} // namespace lambert
