#pragma once

#include <string>
#include <vector>

namespace lambert {

/// A share, which may be negative, with its standard error.
struct ShareBar {
    std::string label; //!< UTF-8
    double share = 0.0, error = 0.0;
    bool rest = false; //!< in grey: what is left
};

/// Shares as horizontal bars with error bars, below each other, as an `<svg>` element for a page.
std::string shareBarsSvg(const std::vector<ShareBar>& bars, const std::string& description);

} // namespace lambert
