#pragma once

#include "picture/image.h"

#include <vector>

namespace lambert {

/// How different two pictures look to someone who flips between them, per pixel, 0 (alike) to 1.
///
/// P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, "FLIP: a difference evaluator for alternating
/// images", HPG 2020. Both are of display colours (linear, in [0, 1]) and of one size. `pixelsPerDegree`: of the observer's
/// field of view; the default is that of a screen of 3840 pixels, 0.7 m wide, seen from 0.7 m.
std::vector<float> flipMap(const Image& reference, const Image& test, double pixelsPerDegree = 67.0206);

/// Mean over the pixels.
double meanOf(const std::vector<float>& map);

/// 10 log10(1 / MSE) of the sRGB-encoded colours, in dB; infinite for equal pictures.
double peakSignalToNoise(const Image& reference, const Image& test);

} // namespace lambert
