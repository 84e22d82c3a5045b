#pragma once

#include "baking/write_baked.h"

#include <string>

/// The content of baked files, as bytes in memory. What each holds is said in write_baked.h.
namespace lambert {

/// A glTF 2.0 asset: a GLB container if `binary`, else JSON with the buffer as a data URI. Throws SystemError
/// above 2^32 bytes.
std::string encodeGltf(const BakedMesh& mesh, const BakeOutputOptions& options, bool binary);

std::string encodePly(const BakedMesh& mesh, const BakeOutputOptions& options);

/// `materialFile` is the name of the file with encodeMtl's content.
std::string encodeObj(const BakedMesh& mesh, const BakeOutputOptions& options, const std::string& materialFile);
std::string encodeMtl(const BakedMesh& mesh);

/// "radiosity" or "irradiance".
const char* nameOf(Quantity quantity);

} // namespace lambert
