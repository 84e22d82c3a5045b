#pragma once

#include "baking/baked_mesh.h"

#include <filesystem>
#include <optional>
#include <string>

namespace lambert {

enum class BakedFormat { Glb, Gltf, Ply, Obj };

/// The format that a file name's extension stands for (upper or lower case), if it is one of them.
std::optional<BakedFormat> formatOf(const std::filesystem::path& path);

struct BakeOutputOptions {
    Quantity quantity = Quantity::Radiosity; //!< what the display colours show; Irradiance adds its own attribute
    float exposure = 0.0F;                   //!< EV; display colour = clamp(shown radiance · 2^EV)
    std::string version;                     //!< of Lambert, named as the generator
};

/// Writes the mesh with its light, whole or not at all, and with the same bytes for the same mesh and options. Faces that are
/// one hole are left out; those that are partly holes are written whole.
///
/// Vertices of a mesh with an origin come back to the file's place: in glTF by the translation of the node, in PLY as doubles, in
/// OBJ with all digits that a double needs.
///
/// - Glb, Gltf (buffer embedded): one mesh, one primitive per material used, unlit; quads are split. `_RADIOSITY` = B per
///   m², linear, unclamped; `_IRRADIANCE` = E if that is the quantity; `COLOR_0` = linear display colour in [0, 1].
/// - Ply: binary little-endian, quads stay; `red green blue` = sRGB display colour, `radiosity_r …` (and `irradiance_r …`)
///   as above.
/// - Obj: `v x y z r g b` with the sRGB display colour in [0, 1]; beside it, a file of the same name ending in .mtl that
///   names the materials.
///
/// Throws SystemError if the file cannot be written, if a glTF would exceed 2^32 bytes, or if the mesh holds a value that
/// is not finite.
void writeBaked(const BakedMesh& mesh, const std::filesystem::path& path, BakedFormat format,
                const BakeOutputOptions& options);

} // namespace lambert
