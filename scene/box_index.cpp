#include "scene/box_index.h"

#include <boost/function_output_iterator.hpp>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <glm/common.hpp>

#include <algorithm>
#include <utility>

namespace lambert {

namespace {

using Point = boost::geometry::model::point<float, 3, boost::geometry::cs::cartesian>;
using Box = boost::geometry::model::box<Point>;
using Entry = std::pair<Box, std::uint32_t>;
using Tree = boost::geometry::index::rtree<Entry, boost::geometry::index::quadratic<16>>;

Box boxOf(const Bounds& bounds) {
    const auto& [lower, upper] = bounds;
    return {Point(lower.x, lower.y, lower.z), Point(upper.x, upper.y, upper.z)};
}

} // namespace

struct BoxIndex::Impl {
    std::vector<Bounds> boxes;
    Tree tree;
};

BoxIndex::BoxIndex(std::vector<Bounds> boxes) : impl_(std::make_unique<Impl>()) {
    std::vector<Entry> entries;
    entries.reserve(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i) entries.emplace_back(boxOf(boxes[i]), i);
    impl_->boxes = std::move(boxes);
    impl_->tree = Tree(entries);
}

BoxIndex::~BoxIndex() = default;

void BoxIndex::meeting(const Bounds& box, std::vector<std::uint32_t>& found) const {
    found.clear();
    const auto take = [&](const Entry& entry) { found.push_back(entry.second); };
    impl_->tree.query(boost::geometry::index::intersects(boxOf(box)), boost::make_function_output_iterator(take));
    std::sort(found.begin(), found.end());
}

void BoxIndex::nearLater(std::uint32_t index, std::vector<std::uint32_t>& found) const {
    meeting(impl_->boxes[index], found);
    found.erase(found.begin(), std::upper_bound(found.begin(), found.end(), index));
}

std::vector<Bounds> boxesOf(std::span<const glm::vec3> positions) {
    std::vector<Bounds> boxes;
    boxes.reserve(positions.size());
    for (const glm::vec3& p : positions) boxes.push_back({p, p});
    return boxes;
}

std::vector<Bounds> boxesOf(std::span<const glm::vec3> positions,
                            std::span<const std::pair<std::uint32_t, std::uint32_t>> edges, float margin) {
    std::vector<Bounds> boxes;
    boxes.reserve(edges.size());
    for (const auto& [from, to] : edges) {
        const glm::vec3 &a = positions[from], &b = positions[to];
        boxes.push_back(Bounds{glm::min(a, b), glm::max(a, b)}.grownBy(margin));
    }
    return boxes;
}

} // namespace lambert
