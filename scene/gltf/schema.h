#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace lambert {

/// Checks that every member that the glTF reader uses has the right type, and that required ones are there. Throws
/// InputError with `file` and the JSON path. Does not check that an index is below the length of its list.
void checkGltfMembers(const std::string& file, const nlohmann::json& document);

} // namespace lambert
