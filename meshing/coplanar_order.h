#pragma once

#include "meshing/coplanar_cells.h"
#include "scene/coplanar_pairs.h"
#include "scene/coplanar_sides.h"
#include "scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lambert {

/// What a place shows on its two sides.
struct ShownSheet {
    PolygonSide front, back; //!< polygon kNone: black
    bool along = true;       //!< `front` is seen where the front of the cells' frame is
};

/// Which of the polygons that lie in one plane is seen.
///
/// Those that face the same way lie on each other. From the lowest to the highest: those that do not emit, those that emit; among these
/// the surfaces of which something is seen anyway, then those that would be hidden otherwise, because faces of other materials lie on or
/// under all of them (a rug on a floor); among these the later in the file over the earlier. The front of the highest is seen from the front,
/// the back of the lowest from behind. Of those that face opposite ways each shows its front. But on either side what emits hides what
/// does not. Occluders, and polygons with holes where there is one without, show nothing.
class CoplanarOrder {
public:
    /// `cells` are those of all polygons of whose pairs one must be decided, each polygon in one of them at most.
    CoplanarOrder(const Scene& scene, const std::vector<CoplanarCells>& cells, double tolerance);

    /// Whether a pair shows two things where only one can be: false for those back to back that show their fronts.
    static bool mustDecide(const Scene& scene, const CoplanarPair& pair);

    /// What a triangle of cells shows: one sheet, or one for each polygon if all have holes.
    std::vector<ShownSheet> shown(const CoplanarCells& cells, std::size_t triangle) const;

    /// Of polygons that face the same way, whether `a` lies over `b`.
    bool liesOver(std::uint32_t a, std::uint32_t b) const;

private:
    void findHidden(const CoplanarCells& cells);
    void showWhatGoesOn(const std::vector<CoplanarCells>& cells, double tolerance);
    PolygonSide seen(const CoplanarCells& cells, const std::vector<std::uint32_t>& covering, bool along) const;

    const Scene& scene_;
    std::vector<bool> hidden_; ///< #polygons: nothing of its surface would be seen
};

} // namespace lambert
