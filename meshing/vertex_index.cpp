#include "meshing/vertex_index.h"

#include <boost/function_output_iterator.hpp>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <algorithm>

namespace lambert {

namespace {

using Point = boost::geometry::model::point<float, 3, boost::geometry::cs::cartesian>;
using Box = boost::geometry::model::box<Point>;
using Entry = std::pair<Point, std::uint32_t>;
using Tree = boost::geometry::index::rtree<Entry, boost::geometry::index::quadratic<16>>;

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

} // namespace lambert
