#include "scene/box_index.h"

#include <boost/function_output_iterator.hpp>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <utility>

namespace lambert {

namespace {

using Point = boost::geometry::model::point<float, 3, boost::geometry::cs::cartesian>;
using Box = boost::geometry::model::box<Point>;
using Entry = std::pair<Box, std::uint32_t>;
using Tree = boost::geometry::index::rtree<Entry, boost::geometry::index::quadratic<16>>;

Point point(const glm::vec3& p) { return {p.x, p.y, p.z}; }

} // namespace

struct BoxIndex::Impl {
    std::vector<Entry> boxes;
    Tree tree;
};

BoxIndex::BoxIndex(std::span<const Bounds> boxes) : impl_(std::make_unique<Impl>()) {
    impl_->boxes.reserve(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        impl_->boxes.emplace_back(Box(point(boxes[i].lower), point(boxes[i].upper)), i);
    impl_->tree = Tree(impl_->boxes);
}

BoxIndex::~BoxIndex() = default;

void BoxIndex::nearLater(std::uint32_t index, std::vector<std::uint32_t>& found) const {
    found.clear();
    const auto take = [&](const Entry& entry) {
        if (entry.second > index) found.push_back(entry.second);
    };
    impl_->tree.query(boost::geometry::index::intersects(impl_->boxes[index].first),
                      boost::make_function_output_iterator(take));
    std::sort(found.begin(), found.end());
}

} // namespace lambert
