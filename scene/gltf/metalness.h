#pragma once

#include "scene/texture.h"

#include <memory>
#include <optional>

namespace lambert {

// Metal has no diffuse reflection: of a base colour there remains the share 1 - metalness, and the metalness is the blue
// channel of the metallic-roughness texture times a factor.

/// The blue channel if it is the same in all texels.
std::optional<float> uniformMetalness(const Texture& metal);
/// The mean of the blue channel.
float meanMetalness(const Texture& metal);

/// The diffuse share of `colour` (null: white), (1 - `factor` · metalness) times each texel, in 8 bits, with the opacity of
/// `colour`. Of two sizes the one with more texels is taken, and the other image read at its nearest texels.
/// 0 <= `factor` <= 1.
std::shared_ptr<const Texture> withoutMetal(const Texture* colour, const Texture& metal, float factor);

} // namespace lambert
