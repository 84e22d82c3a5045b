#pragma once

#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lambert {

/// A mesh with light at its vertices. A vertex belongs to one smoothing side: where light may change abruptly
/// (at creases, material borders and edges on which something stands) there are several vertices at one
/// position.
struct BakedMesh {
    std::vector<glm::vec3> positions; //!< #vertices, metres
    std::vector<glm::vec3> normals;   //!< #vertices, unit length
    std::vector<Rgb> radiosity;       //!< #vertices, B per m², linear, >= 0
    std::vector<Rgb> irradiance;      //!< #vertices, E per m², linear, >= 0
    /// #vertices: quads become triangles along the diagonal over which this changes less; empty: what is shown.
    std::vector<Rgb> splitBy;
    std::vector<std::array<std::uint32_t, 4>>
        faces; //!< one per patch, into the above, counter-clockwise; a triangle ends in kNone
    std::vector<std::uint32_t> faceMaterials; //!< #faces, into materials
    std::vector<Material> materials;
    std::vector<bool> emitters; //!< #faces: the patch emits; or empty: none does
    std::vector<float> opacity; //!< #faces, as PatchMesh::opacity; or empty: no holes at all
    glm::dvec3 origin{0.0};     //!< metres, to which the positions are relative; see Scene::origin

    bool isQuad(std::size_t face) const { return faces[face][3] != kNone; }
};

/// What is shown: B/π of the surface, or E/π of the light that falls on it.
enum class Quantity { Radiosity, Irradiance };

/// The radiance shown at a vertex: B/π or E/π (Rgb, linear).
Rgb shownRadiance(const BakedMesh& mesh, std::size_t vertex, Quantity quantity);

/// Whether the face emits light, an emission texture considered.
bool isEmitter(const BakedMesh& mesh, std::size_t face);

/// Whether nothing of the face is there.
bool isHole(const BakedMesh& mesh, std::size_t face);

/// The mesh without faces that are one hole and vertices that only they use; the rest in order.
BakedMesh withoutHoles(const BakedMesh& mesh);

} // namespace lambert
