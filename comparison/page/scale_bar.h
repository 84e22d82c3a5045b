#pragma once

#include "comparison/page/colour_scale.h"
#include "picture/image.h"

#include <string>

namespace lambert {

/// The picture above a bar with the scale's colours and decades: for a file that is looked at alone.
Image withScaleBar(const Image& picture, const ColourScale& scale);

/// The bar as an `<svg>` element for a page. `name` tells its ids from those of other bars.
std::string scaleBarSvg(const ColourScale& scale, const std::string& name);

} // namespace lambert
