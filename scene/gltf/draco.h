#pragma once

#include "scene/gltf/model.h"

#include <string>

namespace lambert {

/// Replaces the indices, positions, texture coordinates and colours of every primitive compressed by
/// KHR_draco_mesh_compression with accessors of the decompressed data. Throws InputError with `file` and the JSON path if
/// the data are broken, or announce more than their size can justify.
void decompressDraco(const std::string& file, gltf::Model& model);

} // namespace lambert
