#pragma once

#include "meshing/patch_mesh.h"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include <cstddef>

namespace lambert {

struct HalfEdgeTraits : OpenMesh::DefaultTraits {
    VertexAttributes(OpenMesh::Attributes::None);
    HalfedgeAttributes(OpenMesh::Attributes::None);
    EdgeAttributes(OpenMesh::Attributes::None);
    FaceAttributes(OpenMesh::Attributes::None);
};

/// The patches as a half-edge mesh whose vertices belong to one smoothing side each: faces are connected where light is
/// continuous, and creases, material borders and contact lines are boundaries.
struct HalfEdgeMesh {
    OpenMesh::PolyMesh_ArrayKernelT<HalfEdgeTraits> topology; //!< face index = patch index
    /// #patches, the vertices at the patch's corners, in their order; a triangle ends in kNone. The topology's faces begin with
    /// any of them.
    std::vector<std::array<std::uint32_t, 4>> corners;
    std::size_t separatedFaces = 0; //!< refused as non-manifold, given vertices of their own
};

/// Connects two patches across an edge if their materials are the same, their normals differ by less than `creaseAngle`
/// (radians), and nothing stands on the edge. The two sides of a two-sided polygon are never connected.
HalfEdgeMesh buildHalfEdgeMesh(const PatchMesh& mesh, float creaseAngle);

} // namespace lambert
