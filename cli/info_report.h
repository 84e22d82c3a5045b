#pragma once

#include "cli/scene_facts.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <vector>

namespace lambert {

/// What the two reports of a scene tell of.
struct InfoReportInput {
    std::filesystem::path path;
    const ReadResult& read;
    const SceneFacts& facts;
    std::vector<Finding> findings;
};

/// The report as JSON; docs/output.md has its keys.
nlohmann::ordered_json infoReport(const InfoReportInput& input);

/// The report as a page on standard output.
void printInfo(const InfoReportInput& input);

} // namespace lambert
