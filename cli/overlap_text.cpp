#include "cli/overlap_text.h"

#include "core/text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <vector>

namespace lambert {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kNamed = 3;
constexpr std::size_t kInJson = 100;

/// A surface by its node, and by its material where that alone tells it from another.
std::string surfaceName(const Scene& scene, std::uint32_t node, std::uint32_t material, bool sameNode) {
    const std::string name = inQuotes(scene.nodes[node]);
    return sameNode ? fmt::format("{} (material {})", name, inQuotes(scene.materials[material].name)) : name;
}

std::string pairText(const Scene& scene, const CoplanarOverlap& overlap) {
    const bool sameNode = scene.nodes[overlap.upperNode] == scene.nodes[overlap.lowerNode];
    return fmt::format("{} covers {:.3g} m² of {}",
                       surfaceName(scene, overlap.upperNode, overlap.upperMaterial, sameNode), overlap.area,
                       surfaceName(scene, overlap.lowerNode, overlap.lowerMaterial, sameNode));
}

Json surfaceJson(const Scene& scene, std::uint32_t node, std::uint32_t material) {
    return {{"node", scene.nodes[node]}, {"material", scene.materials[material].name}};
}

} // namespace

std::string overlapText(const Scene& scene, const CoverReport& report) {
    if (report.overlaps.empty()) return {};
    std::vector<std::string> pairs;
    for (const CoplanarOverlap& overlap : report.overlaps) {
        if (pairs.size() == kNamed) break;
        pairs.push_back(pairText(scene, overlap));
    }
    const std::size_t more = report.overlaps.size() - pairs.size();
    std::string text = fmt::format("faces overlap in one plane: {}", fmt::join(pairs, ", "));
    if (more > 0) text += fmt::format(", and {} more such pair{}", more, more == 1 ? "" : "s");
    if (!report.takenAway) text += "; with --patches 0 none is cut: what is covered counts as free";
    return text;
}

Json overlapsJson(const Scene& scene, const CoverReport& report) {
    Json list = Json::array();
    for (const CoplanarOverlap& overlap : report.overlaps) {
        if (list.size() == kInJson) break;
        list.push_back({{"upper", surfaceJson(scene, overlap.upperNode, overlap.upperMaterial)},
                        {"lower", surfaceJson(scene, overlap.lowerNode, overlap.lowerMaterial)},
                        {"area", overlap.area}});
    }
    return list;
}

} // namespace lambert
