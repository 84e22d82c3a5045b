#include "meshing/spatial_index.h"

#include <boost/function_output_iterator.hpp>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <glm/common.hpp>

#include <algorithm>

namespace lambert {

namespace {

using Point = boost::geometry::model::point<float, 3, boost::geometry::cs::cartesian>;
using Box = boost::geometry::model::box<Point>;
using Entry = std::pair<Point, std::uint32_t>;
using Tree = boost::geometry::index::rtree<Entry, boost::geometry::index::quadratic<16>>;

using BoxEntry = std::pair<Box, std::uint32_t>;
using BoxTree = boost::geometry::index::rtree<BoxEntry, boost::geometry::index::quadratic<16>>;

Point point(const glm::vec3& p) { return {p.x, p.y, p.z}; }

std::vector<Entry> entries(std::span<const glm::vec3> positions) {
    std::vector<Entry> result;
    result.reserve(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) result.emplace_back(point(positions[i]), i);
    return result;
}

} // namespace

struct VertexIndex::Impl {
    Tree tree;
};

VertexIndex::VertexIndex(std::span<const glm::vec3> positions)
    : impl_(std::make_unique<Impl>(Impl{Tree(entries(positions))})) {}

VertexIndex::~VertexIndex() = default;

void VertexIndex::inBox(const glm::vec3& lower, const glm::vec3& upper, std::vector<std::uint32_t>& found) const {
    found.clear();
    const auto take = [&found](const Entry& entry) { found.push_back(entry.second); };
    impl_->tree.query(boost::geometry::index::intersects(Box(point(lower), point(upper))),
                      boost::make_function_output_iterator(take));
    std::sort(found.begin(), found.end());
}

struct EdgeIndex::Impl {
    std::vector<BoxEntry> boxes;
    BoxTree tree;
};

EdgeIndex::EdgeIndex(std::span<const glm::vec3> positions, std::span<const Edge> edges, float margin)
    : impl_(std::make_unique<Impl>()) {
    impl_->boxes.reserve(edges.size());
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
        const glm::vec3 a = positions[edges[i].first];
        const glm::vec3 b = positions[edges[i].second];
        impl_->boxes.emplace_back(Box(point(glm::min(a, b) - margin), point(glm::max(a, b) + margin)), i);
    }
    impl_->tree = BoxTree(impl_->boxes);
}

EdgeIndex::~EdgeIndex() = default;

void EdgeIndex::nearLater(std::uint32_t index, std::vector<std::uint32_t>& found) const {
    found.clear();
    const auto take = [&](const BoxEntry& entry) {
        if (entry.second > index) found.push_back(entry.second);
    };
    impl_->tree.query(boost::geometry::index::intersects(impl_->boxes[index].first),
                      boost::make_function_output_iterator(take));
    std::sort(found.begin(), found.end());
}

void EdgeIndex::inBox(const glm::vec3& lower, const glm::vec3& upper, std::vector<std::uint32_t>& found) const {
    found.clear();
    const auto take = [&](const BoxEntry& entry) { found.push_back(entry.second); };
    impl_->tree.query(boost::geometry::index::intersects(Box(point(lower), point(upper))),
                      boost::make_function_output_iterator(take));
    std::sort(found.begin(), found.end());
}

} // namespace lambert
