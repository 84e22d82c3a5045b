#pragma once

#include "scene/scene.h"

#include <cstddef>
#include <vector>

namespace lambert {

/// Polygons that hang together across shared edges.
struct Shell {
    std::size_t polygons = 0;
    double area = 0.0;                 //!< m²
    std::size_t openEdges = 0;         //!< with nothing on their other side
    std::size_t branchedEdges = 0;     //!< shared by three or more polygons
    std::size_t inconsistentEdges = 0; //!< shared by two that face opposite ways
    bool oneSided = true;              //!< every polygon has a front and a black back
    double volume = 0.0;               //!< m³; negative if the fronts face inward. 0 if open or inconsistent
    Bounds bounds;
    std::uint32_t node = 0;     //!< of its largest polygon, into Scene::nodes
    std::uint32_t material = 0; //!< of its largest polygon, into Scene::materials
    /// Closed, with its fronts inside, but no room: it lies inside the bounds of another shell and holds none itself.
    bool insideOut = false;

    bool isClosed() const { return openEdges == 0 && branchedEdges == 0; }
};

/// What the polygons of a scene are as surfaces. An edge is what lies between two vertices of the scene, so that a long side
/// is matched by the several shorter ones along it.
struct SurfaceCheck {
    std::size_t openEdges = 0, branchedEdges = 0, inconsistentEdges = 0; //!< sums over the shells
    std::size_t closedShells = 0;
    std::size_t insideOutShells = 0;
    std::vector<Shell> shells; //!< largest area first
};

/// Checks a prepared scene (see prepareScene). Where more than two polygons meet at an edge, those of one node are taken
/// together first: a box that stands on another is two shells. Occluders count as
/// surfaces that face both ways.
SurfaceCheck checkSurfaces(const Scene& scene);

} // namespace lambert
