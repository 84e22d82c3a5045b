#pragma once

#include <filesystem>

namespace lambert {

/// Where and how often unfinished work is kept.
struct CheckpointOptions {
    std::filesystem::path path; //!< empty: nowhere
    bool resume = false;        //!< goes on with the file if it is there; else it must not be there
    double seconds = 60.0;      //!< between two writings
};

} // namespace lambert
