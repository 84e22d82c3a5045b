#include "formfactors/block_visibility.h"

#include "core/box.h"
#include "core/parallel.h"
#include "formfactors/closed_form.h"

#include <glm/vec2.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace lambert {

namespace {

/// The smallest rectangle around points of a plane that has a side along one of these directions.
ConvexPolygon rectangleAround(std::span<const glm::dvec3> points, const Plane& plane,
                              std::span<const glm::dvec3> directions) {
    ConvexPolygon best;
    double smallest = std::numeric_limits<double>::max();
    for (const glm::dvec3& direction : directions) {
        const glm::dvec3 u = glm::normalize(direction - glm::dot(direction, plane.normal) * plane.normal);
        const glm::dvec3 v = glm::cross(plane.normal, u);
        Box<glm::dvec2> box;
        for (const glm::dvec3& p : points) box.add({glm::dot(p, u), glm::dot(p, v)});
        const auto [lower, upper] = box;
        const double area = (upper.x - lower.x) * (upper.y - lower.y);
        if (!(area < smallest)) continue;
        smallest = area;
        const glm::dvec3 base = plane.offset * plane.normal;
        best = ConvexPolygon();
        best.add(base + lower.x * u + lower.y * v);
        best.add(base + upper.x * u + lower.y * v);
        best.add(base + upper.x * u + upper.y * v);
        best.add(base + lower.x * u + upper.y * v);
    }
    return best;
}

/// The plane of a flat block, to the front of its patches.
Plane planeOf(const Occluder& occluder, const glm::vec3& front) {
    Plane plane = occluder.plane;
    if (glm::dot(plane.normal, glm::dvec3(front)) < 0.0) {
        plane.normal = -plane.normal;
        plane.offset = -plane.offset;
    }
    return plane;
}

double areaOf(std::span<const glm::dvec3> polygon) { return glm::length(polygonAreaVector(polygon)); }

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace

/// What stands between one block and all others. Down the blocks' tree each node tests what stood between its parent and the block;
/// small occluders by whole branches of theirs, as they are counted only up to kMostCandidates.
class BlockVisibility::Search {
public:
    Search(const BlockVisibility& whole, std::uint32_t block)
        : whole_(whole), block_(block), hull_(whole.hulls_[block]) {}

    void run(Row& row) {
        row_ = &row;
        const std::size_t others = whole_.hulls_.size() - block_;
        row.first.assign(others, 0);
        row.count.assign(others, 0);
        stack_.clear();
        for (const std::uint32_t occluder : whole_.large_) stack_.push_back({occluder, true});
        if (!whole_.smallTree_.empty()) stack_.push_back({0, false});
        visit(0, 0);
    }

private:
    struct Candidate {
        std::uint32_t index; ///< of an occluder, or a node of the small ones' tree
        bool single;
    };

    /// Candidates are on the stack from `first` on, and left there.
    void visit(std::uint32_t index, std::size_t first) {
        const Node& node = whole_.blockTree_[index];
        if (node.item < block_) return;
        if (node.left == 0) return leaf(node.item, first);
        const std::size_t end = stack_.size();
        Extents both = hull_.extents;
        both.add(node.extents);
        for (std::size_t k = first; k < end; ++k) {
            const Candidate c = stack_[k];
            if (!c.single)
                pushChildren(c.index, node.extents, both);
            else if (mayStand(c.index, node.extents, both))
                stack_.push_back(c);
        }
        if (stack_.size() > end) {
            visit(node.left, end);
            visit(node.right, end);
        }
        stack_.resize(end);
    }

    void leaf(std::uint32_t other, std::size_t first) {
        const Hull& hull = whole_.hulls_[other];
        Extents both = hull_.extents;
        both.add(hull.extents);
        found_.clear();
        const std::size_t end = stack_.size();
        bool hidden = false;
        for (std::size_t k = first; k < end && !hidden; ++k) {
            const Candidate c = stack_[k];
            if (!c.single)
                pushChildren(c.index, hull.extents, both);
            else
                hidden = hides(c.index, hull, both);
        }
        while (stack_.size() > end && !hidden && found_.size() <= kMostCandidates) {
            const Candidate c = stack_.back();
            stack_.pop_back();
            if (!c.single)
                pushChildren(c.index, hull.extents, both);
            else
                hidden = hides(c.index, hull, both);
        }
        stack_.resize(end);
        const std::size_t at = other - block_;
        if (hidden || found_.size() > kMostCandidates) {
            row_->count[at] = hidden ? kHidden : kMany;
            return;
        }
        row_->count[at] = static_cast<std::uint8_t>(found_.size());
        row_->first[at] = static_cast<std::uint32_t>(row_->candidates.size());
        row_->candidates.insert(row_->candidates.end(), found_.begin(), found_.end());
    }

    /// Whether an occluder hides all; notes it where it may hide some.
    bool hides(std::uint32_t index, const Hull& hull, const Extents& both) {
        if (!mayStand(index, hull.extents, both)) return false;
        const Blocking found =
            hull_.polygon.empty() || hull.polygon.empty()
                ? Blocking::Unknown
                : whole_.between(hull_.polygon, hull_.plane, hull.polygon, hull.plane, whole_.occluders_.list[index]);
        if (found == Blocking::Unknown) found_.push_back(index);
        return found == Blocking::Hidden;
    }

    /// Of a node of the small ones' tree, what may stand between.
    void pushChildren(std::uint32_t index, const Extents& there, const Extents& both) {
        const Node& node = whole_.smallTree_[index];
        if (both.apart(node.extents, whole_.directions_.list().size(), whole_.tolerance_)) return;
        if (node.left != 0) {
            stack_.push_back({node.left, false});
            stack_.push_back({node.right, false});
        } else if (mayStand(node.item, there, both)) {
            stack_.push_back({node.item, true});
        }
    }

    bool mayStand(std::uint32_t index, const Extents& there, const Extents& both) const {
        const Occluder& occluder = whole_.occluders_.list[index];
        const std::span<const glm::dvec3> directions = whole_.directions_.list();
        if (both.apart(occluder.extents, directions.size(), whole_.tolerance_)) return false;
        const auto near = hull_.polygon.empty() ? hull_.extents.heights(occluder.plane, directions)
                                                : cornerHeights(occluder.plane, hull_.polygon.points());
        const auto far = there.heights(occluder.plane, directions);
        if (near[0] >= -whole_.tolerance_ && far[0] >= -whole_.tolerance_) return false;
        return !(near[1] <= whole_.tolerance_ && far[1] <= whole_.tolerance_);
    }

    const BlockVisibility& whole_;
    std::uint32_t block_;
    const Hull& hull_;
    Row* row_ = nullptr;
    std::vector<Candidate> stack_;
    std::vector<std::uint32_t> found_;
};

BlockVisibility::Tree BlockVisibility::treeOver(std::vector<Leaf> leaves) {
    Tree tree;
    if (!leaves.empty()) addNode(tree, leaves);
    return tree;
}

std::uint32_t BlockVisibility::addNode(Tree& tree, std::span<Leaf> leaves) {
    const auto index = static_cast<std::uint32_t>(tree.size());
    Node node{leaves[0].extents, leaves[0].item};
    Box<glm::dvec3> centres;
    for (const Leaf& leaf : leaves) {
        node.extents.add(leaf.extents);
        node.item = std::max(node.item, leaf.item);
        centres.add(leaf.extents.centre());
    }
    tree.push_back(node);
    if (leaves.size() == 1) return index;
    const glm::dvec3 size = centres.size();
    const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = leaves.size() / 2;
    std::nth_element(leaves.begin(), leaves.begin() + static_cast<std::ptrdiff_t>(half), leaves.end(),
                     [axis](const Leaf& a, const Leaf& b) {
                         return std::pair(a.extents.centre()[axis], a.item) <
                                std::pair(b.extents.centre()[axis], b.item);
                     });
    const std::uint32_t left = addNode(tree, leaves.first(half));
    const std::uint32_t right = addNode(tree, leaves.subspan(half));
    tree[index].left = left;
    tree[index].right = right;
    return index;
}

BlockVisibility::BlockVisibility(const Scene& scene, const PatchMesh& mesh, const PatchBlocks& blocks, double tolerance)
    : tolerance_(tolerance), occluders_(gatherOccluders(scene, directions_, tolerance)) {
    std::vector<double> areas;
    std::vector<Leaf> blockLeaves, smallLeaves;
    std::vector<glm::dvec3> corners, sides;
    for (const PatchBlocks::Block& block : blocks.blocks()) {
        corners.clear();
        sides.clear();
        for (std::uint32_t lane = 0; lane < block.count; ++lane) {
            const std::uint32_t patch = block.patch[lane];
            const int count = mesh.cornerCount(patch);
            for (int k = 0; k < count; ++k) {
                corners.emplace_back(mesh.position(patch, k));
                sides.push_back(glm::dvec3(mesh.position(patch, (k + 1) % count)) - corners.back());
            }
        }
        Hull& hull = hulls_.emplace_back();
        for (const glm::dvec3& p : corners) hull.extents.add(p, directions_.list());
        blockLeaves.push_back({hull.extents, static_cast<std::uint32_t>(blockLeaves.size())});
        if (!block.flat) continue;
        const std::uint32_t first = block.patch[0];
        hull.plane = planeOf(occluders_.list[occluders_.ofPolygon[mesh.polygon[first]]], mesh.normal[first]);
        hull.polygon = rectangleAround(corners, hull.plane, sides);
        areas.push_back(areaOf(hull.polygon.points()));
    }
    blockTree_ = treeOver(std::move(blockLeaves));

    const double limit = median(std::move(areas));
    for (std::uint32_t k = 0; k < occluders_.list.size(); ++k) {
        const Occluder& occluder = occluders_.list[k];
        if (areaOf(occluder.corners) >= limit)
            large_.push_back(k);
        else
            smallLeaves.push_back({occluder.extents, k});
    }
    smallTree_ = treeOver(std::move(smallLeaves));

    rows_.resize(hulls_.size());
    parallelFor(hulls_.size(), 4, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t a = begin; a < end; ++a) Search(*this, static_cast<std::uint32_t>(a)).run(rows_[a]);
    });
}

Blocking BlockVisibility::between(const ConvexPolygon& a, const Plane& planeA, const ConvexPolygon& b,
                                  const Plane& planeB, const Occluder& occluder) const {
    // Only what lies in front of the other's plane matters.
    ConvexPolygon partA, partB, behind;
    split(a, planeB, tolerance_, partA, behind);
    if (partA.empty()) return Blocking::Clear;
    split(b, planeA, tolerance_, partB, behind);
    if (partB.empty()) return Blocking::Clear;
    return blocking(partA, planeA, partB, planeB, occluder, tolerance_);
}

Blocking BlockVisibility::between(std::uint32_t a, std::uint32_t b) const {
    const Row& row = rows_[std::min(a, b)];
    const std::uint8_t count = row.count[std::max(a, b) - std::min(a, b)];
    return count == 0 ? Blocking::Clear : count == kHidden ? Blocking::Hidden : Blocking::Unknown;
}

Blocking BlockVisibility::between(const ConvexPolygon& patch, const Plane& plane, std::uint32_t a,
                                  std::uint32_t b) const {
    if (const Blocking known = between(a, b); known != Blocking::Unknown) return known;
    const Row& row = rows_[std::min(a, b)];
    const std::size_t at = std::max(a, b) - std::min(a, b);
    const Hull& hull = hulls_[b];
    if (row.count[at] == kMany || hull.polygon.empty()) return Blocking::Unknown;
    bool clear = true;
    for (std::size_t k = 0; k < row.count[at]; ++k) {
        const Blocking found =
            between(patch, plane, hull.polygon, hull.plane, occluders_.list[row.candidates[row.first[at] + k]]);
        if (found == Blocking::Hidden) return found;
        clear = clear && found == Blocking::Clear;
    }
    return clear ? Blocking::Clear : Blocking::Unknown;
}

} // namespace lambert
