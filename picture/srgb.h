#pragma once

namespace lambert {

/// The transfer curve of IEC 61966-2-1: a linear value to the encoded one. Clamps to [0, 1].
float srgbEncode(float linear);

/// Its inverse: the linear value of an encoded one, both 0 to 1.
double srgbDecoded(double value);

} // namespace lambert
