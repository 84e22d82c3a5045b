#pragma once

#include "baking/write_baked.h"

#include <ostream>
#include <string>

/// The content of baked files, written piece by piece. What each holds is said in write_baked.h.
namespace lambert {

/// A glTF 2.0 asset without faces that are one hole: a GLB container if `binary`, else JSON with the buffer as a data URI.
/// Throws SystemError with the name `file` above 2^32 bytes.
void encodeGltf(const BakedMesh& mesh, const BakeOutputOptions& options, bool binary, const std::string& file,
                std::ostream& stream);

// The others write all faces: give them the mesh withoutHoles.

void encodePly(const BakedMesh& mesh, const BakeOutputOptions& options, std::ostream& stream);

/// `materialFile` is the name of the file with encodeMtl's content.
void encodeObj(const BakedMesh& mesh, const BakeOutputOptions& options, const std::string& materialFile,
               std::ostream& stream);
void encodeMtl(const BakedMesh& mesh, std::ostream& stream);

/// "radiosity" or "irradiance".
const char* nameOf(Quantity quantity);

} // namespace lambert
