#pragma once

#include <filesystem>
#include <string>

namespace lambert {

/// Where and how often unfinished work is kept.
struct CheckpointOptions {
    std::filesystem::path path; //!< empty: nowhere
    bool resume = false;        //!< goes on with the file if it is there; else it must not be there
    double seconds = 60.0;      //!< between two writings
    std::string version{};      //!< of the program: no other goes on with the file
};

} // namespace lambert
