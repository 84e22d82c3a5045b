#include "scene/gltf/nodes.h"

#include "scene/gltf/document.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>

namespace lambert {

namespace {

/// A node to be visited, and the JSON path of the reference to it.
struct Visit {
    int index;
    std::string referrer;
    glm::dmat4 parentToWorld;
};

glm::dmat4 localTransform(const std::string& file, const gltf::Node& node, int index) {
    if (node.matrix) return *node.matrix;
    const glm::dvec4& q = node.rotation;
    const glm::dquat rotation(q.w, q.x, q.y, q.z);
    const double length = glm::length(rotation);
    if (!(length > 0.0)) failAtMember(file, fmt::format("/nodes/{}/rotation", index), "0 0 0 0", "a unit quaternion");
    return glm::scale(glm::translate(glm::dmat4(1.0), node.translation) * glm::mat4_cast(rotation / length),
                      node.scale);
}

std::vector<Visit> rootVisits(const std::string& file, const gltf::Model& model) {
    std::vector<Visit> roots;
    if (!model.scenes.empty()) {
        const int scene = model.scene < 0 ? 0 : model.scene;
        if (static_cast<std::size_t>(scene) >= model.scenes.size())
            failAtMember(file, "/scene", std::to_string(scene), fmt::format("0 to {}", model.scenes.size() - 1));
        const std::vector<int>& nodes = model.scenes[static_cast<std::size_t>(scene)].nodes;
        for (std::size_t k = 0; k < nodes.size(); ++k)
            roots.push_back({nodes[k], fmt::format("/scenes/{}/nodes/{}", scene, k), glm::dmat4(1.0)});
        return roots;
    }
    std::vector<bool> hasParent(model.nodes.size(), false);
    for (const gltf::Node& node : model.nodes)
        for (const int child : node.children)
            if (static_cast<std::size_t>(child) < hasParent.size()) hasParent[static_cast<std::size_t>(child)] = true;
    for (std::size_t k = 0; k < hasParent.size(); ++k)
        if (!hasParent[k]) roots.push_back({static_cast<int>(k), fmt::format("/nodes/{}", k), glm::dmat4(1.0)});
    return roots;
}

} // namespace

double largestScale(const glm::dmat4& transform) {
    double longest = 0.0;
    for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, glm::length(glm::dvec3(transform[axis])));
    return longest;
}

std::vector<GltfNode> collectGltfNodes(const std::string& file, const gltf::Model& model) {
    std::vector<GltfNode> nodes;
    std::vector<bool> reached(model.nodes.size(), false);
    std::vector<Visit> stack = rootVisits(file, model);
    std::reverse(stack.begin(), stack.end());
    while (!stack.empty()) {
        const Visit visit = std::move(stack.back());
        stack.pop_back();
        const auto index = static_cast<std::size_t>(visit.index);
        if (index >= model.nodes.size())
            failAtMember(file, visit.referrer, std::to_string(visit.index),
                         fmt::format("a node below {} (the number of nodes)", model.nodes.size()));
        if (reached[index])
            failAtMember(file, visit.referrer, fmt::format("node {} again", visit.index),
                         "each node once (no cycles, one parent)");
        reached[index] = true;

        const gltf::Node& node = model.nodes[index];
        nodes.push_back({visit.index, visit.parentToWorld * localTransform(file, node, visit.index)});
        for (std::size_t k = node.children.size(); k-- > 0;)
            stack.push_back({node.children[k], fmt::format("/nodes/{}/children/{}", index, k), nodes.back().toWorld});
    }
    return nodes;
}

} // namespace lambert
