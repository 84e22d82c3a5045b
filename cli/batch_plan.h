#pragma once

#include "cli/bake_job.h"

#include <vector>

namespace lambert {

/// The scenes that were named, as files or as folders to be searched, and where each bake goes under --output-dir: the
/// scene's path relative to the folder that all arguments have in common. Files in their order, those of a folder sorted;
/// hidden files and folders, links to folders, and the output folder itself are left out.
///
/// Writes nothing. Throws UsageError if two scenes would become one file, if something that is read would be overwritten,
/// or if one picture is asked for several scenes; InputError for a folder without scenes.
std::vector<BakeJob> planBatch(const BakeArguments& arguments);

} // namespace lambert
