#pragma once

#include "scene/gltf/model.h"

#include <string>

namespace lambert {

/// Replaces every buffer view compressed by EXT_meshopt_compression (or KHR_meshopt_compression, as far as that is the
/// same) with one of the decompressed data. Throws InputError with `file` and the JSON path if the data are broken.
void decompressMeshopt(const std::string& file, gltf::Model& model);

} // namespace lambert
