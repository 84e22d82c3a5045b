#pragma once

#include <string>
#include <vector>

namespace lambert {

/// Makes one line of four or more that differ only in what stands in double quotes and in numbers: the first of them, with
/// the number of the others and what the next few name. Order is kept otherwise.
std::vector<std::string> mergeWarnings(const std::vector<std::string>& warnings);

} // namespace lambert
