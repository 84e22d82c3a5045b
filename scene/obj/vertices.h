#pragma once

#include "scene/obj/lines.h"
#include "scene/scene_builder.h"

#include <glm/vec2.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace lambert {

/// What an OBJ file says beside its faces, which may name vertices and materials before the file has them.
struct ObjVertices {
    std::size_t positions = 0;          //!< `v` statements; SceneBuilder has them, by the same numbers
    std::vector<glm::vec2> uv;          //!< `vt` statements, v upwards
    std::vector<Rgb> tints;             //!< of every position, linear; empty if no `v` has a colour
    std::vector<std::string> libraries; //!< arguments of the `mtllib` statements, unsplit
    std::size_t faces = 0;
    std::size_t pointsAndLines = 0;
    std::size_t curvesAndSurfaces = 0;
};

/// Goes through the file and adds the positions to `builder`, times `metresPerUnit`. Throws InputError, with file, line,
/// what was found and what is expected, if a statement is malformed.
ObjVertices readObjVertices(ObjLines& lines, double metresPerUnit, SceneBuilder& builder);

} // namespace lambert
