#include "solver/emitter_tree.h"

#include "core/box.h"
#include "meshing/patch_offset.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace lambert {

namespace {

constexpr std::size_t kMostTerminals = 192;
constexpr double kCutError = 2e-3;  ///< of what all nodes send
constexpr double kFarRatio = 0.1;   ///< nodes of more radii per distance are no points
constexpr double kWholeArea = 1e-3; ///< relative, by which the patches of a polygon may miss its area

/// An angle from 0 to π by its cosine and sine: sums and differences without trigonometry.
struct Angle {
    double cosine, sine;

    static Angle ofSine(double sine) { return {std::sqrt(std::max(0.0, 1.0 - sine * sine)), sine}; } ///< at most π/2
    static Angle ofCosine(double cosine) { return {cosine, std::sqrt(std::max(0.0, 1.0 - cosine * cosine))}; }
    /// At most π.
    Angle plus(const Angle& o) const {
        if (cosine <= -o.cosine) return {-1.0, 0.0};
        return {cosine * o.cosine - sine * o.sine, sine * o.cosine + cosine * o.sine};
    }
    /// At least 0.
    Angle minus(const Angle& o) const {
        if (cosine >= o.cosine) return {1.0, 0.0};
        return {cosine * o.cosine + sine * o.sine, sine * o.cosine - cosine * o.sine};
    }
};

/// What a node sends to a plane, as far as its ball, its cone and its power tell.
struct Reckoning {
    double value = 0.0; ///< about
    double most = 0.0;  ///< not more, about
    double error = 0.0; ///< of taking it for a point
    bool asPoint = false;
};

Reckoning reckon(const EmitterNode& node, const ReceiverPlane& plane) {
    Reckoning result;
    const glm::dvec3 toPlane = plane.centre - node.centre;
    const double height = -glm::dot(toPlane, plane.normal);
    if (height <= -node.radius) return result;
    const double distance = glm::length(toPlane);
    const double reach = node.radius + plane.radius;
    const bool apart = distance > reach;
    const Angle spread{node.spreadCosine, node.spreadSine};
    const Angle extent = apart ? Angle::ofSine(reach / distance) : Angle{-1.0, 0.0};
    const Angle turned = apart ? Angle::ofCosine(glm::dot(node.axis, toPlane) / distance) : Angle{1.0, 0.0};
    const double least = turned.minus(spread).minus(extent).cosine;
    if (!(least > 0.0)) return result;
    const double nearest = std::max(distance - reach, node.radius);
    const double horizon = apart ? std::min(1.0, (height + node.radius) / nearest) : 1.0;
    result.most = node.power * least * horizon / (std::numbers::pi * nearest * nearest);
    const bool facing = turned.plus(spread).plus(extent).cosine > 0.0;
    if (!apart || !facing || height <= node.radius) {
        result.value = result.error = result.most;
        return result;
    }
    const double squared = distance * distance;
    const double flux = glm::dot(node.flux[0] + node.flux[1] + node.flux[2], toPlane);
    result.value = std::max(0.0, flux * height / (std::numbers::pi * squared * squared));
    const double ratio = node.radius / (distance - plane.radius);
    result.error = result.value * ratio * ratio;
    result.asPoint = ratio <= kFarRatio;
    return result;
}

struct Opened {
    Reckoning reckoned;
    std::uint32_t node;
    bool operator<(const Opened& other) const {
        if (reckoned.error != other.reckoned.error) return reckoned.error < other.reckoned.error;
        return node < other.node;
    }
};

} // namespace

double EmitterTriangle::radius() const {
    double squared = 0.0;
    const glm::dvec3 centre = centroid();
    for (const glm::dvec3& p : corners) squared = std::max(squared, glm::dot(p - centre, p - centre));
    return std::sqrt(squared);
}

EmitterTree::EmitterTree(const RayCaster& rays, const PatchMesh& mesh, const PatchOptics& optics) {
    collect(rays, mesh, optics);
    std::vector<std::uint32_t> order(triangles_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return triangles_[a].group < triangles_[b].group; });
    for (auto first = order.begin(); first != order.end();) {
        const std::uint32_t group = triangles_[*first].group;
        const auto last = std::find_if(first, order.end(), [&](auto t) { return triangles_[t].group != group; });
        roots_.push_back(build({first, last}));
        first = last;
    }
}

/// A polygon's side emits as one if its patches are all of it and emit alike.
void EmitterTree::collect(const RayCaster& rays, const PatchMesh& mesh, const PatchOptics& optics) {
    const Scene& scene = rays.scene();
    for (std::size_t i = 0; i < mesh.size(); ++i)
        if (optics.emittedRadiosity[i] != Rgb(0.0F)) groups_.push_back(mesh.material[i]);
    std::sort(groups_.begin(), groups_.end());
    groups_.erase(std::unique(groups_.begin(), groups_.end()), groups_.end());
    const auto sameSide = [&](std::size_t a, std::size_t b) {
        return mesh.polygon[a] == mesh.polygon[b] && mesh.isBack(a) == mesh.isBack(b);
    };
    for (std::size_t first = 0; first < mesh.size();) {
        std::size_t last = first;
        bool alike = true;
        double area = 0.0;
        for (; last < mesh.size() && sameSide(first, last); ++last) {
            alike = alike && optics.emittedRadiosity[last] == optics.emittedRadiosity[first];
            area += static_cast<double>(mesh.area[last]);
        }
        const Rgb emitted = optics.emittedRadiosity[first];
        const auto group = static_cast<std::uint32_t>(
            std::lower_bound(groups_.begin(), groups_.end(), mesh.material[first]) - groups_.begin());
        const double whole = polygonArea(scene, scene.polygons[mesh.polygon[first]]);
        if (alike && std::abs(area - whole) <= kWholeArea * whole) {
            if (emitted != Rgb(0.0F)) addPolygon(rays, mesh.polygon[first], mesh.isBack(first), RgbSum(emitted), group);
        } else {
            for (std::size_t i = first; i < last; ++i)
                if (optics.emittedRadiosity[i] != Rgb(0.0F))
                    addPatch(rays, mesh, i, RgbSum(optics.emittedRadiosity[i]), group);
        }
        first = last;
    }
}

void EmitterTree::addPolygon(const RayCaster& rays, std::uint32_t polygon, bool back, const RgbSum& radiosity,
                             std::uint32_t group) {
    const Scene& scene = rays.scene();
    const Polygon& p = scene.polygons[polygon];
    const double lift = static_cast<double>(rays.originOffset(static_cast<float>(std::sqrt(polygonArea(scene, p)))));
    const auto at = [&](int k) { return glm::dvec3(corner(scene, p, k)); };
    for (int k = 1; k + 1 < p.size(); ++k) {
        const std::array corners = back ? std::array{at(0), at(k + 1), at(k)} : std::array{at(0), at(k), at(k + 1)};
        add({corners, {}, 0.0, radiosity, lift, group});
    }
}

void EmitterTree::addPatch(const RayCaster& rays, const PatchMesh& mesh, std::size_t patch, const RgbSum& emitted,
                           std::uint32_t group) {
    const double opacity = mesh.opacity.empty() ? 1.0 : static_cast<double>(mesh.opacity[patch]);
    const RgbSum radiosity = opacity * emitted;
    const double lift = static_cast<double>(patchOriginOffset(rays, mesh, patch));
    const auto at = [&](int k) { return glm::dvec3(mesh.position(patch, k)); };
    for (int k = 1; k + 1 < mesh.cornerCount(patch); ++k)
        add({{at(0), at(k), at(k + 1)}, {}, 0.0, radiosity, lift, group});
}

void EmitterTree::add(EmitterTriangle triangle) {
    const auto& [a, b, c] = triangle.corners;
    const glm::dvec3 areaVector = 0.5 * glm::cross(b - a, c - a);
    triangle.area = glm::length(areaVector);
    if (!(triangle.area > 0.0)) return;
    triangle.normal = areaVector / triangle.area;
    triangles_.push_back(triangle);
}

std::uint32_t EmitterTree::build(std::span<std::uint32_t> list) {
    if (list.size() == 1) {
        const EmitterTriangle& t = triangles_[list[0]];
        EmitterNode node{t.centroid(), t.radius(), t.normal, 1.0, 0.0, {}, t.power(), kNone, list[0]};
        for (int c = 0; c < 3; ++c) node.flux[static_cast<std::size_t>(c)] = t.area * t.radiosity[c] * t.normal;
        nodes_.push_back(node);
        nodeGroup_.push_back(t.group);
        return static_cast<std::uint32_t>(nodes_.size() - 1);
    }
    // In halves, by place or by where they face, whatever differs most.
    Box<glm::dvec3> centroids, normals;
    for (const std::uint32_t t : list) {
        centroids.add(triangles_[t].centroid());
        normals.add(triangles_[t].normal);
    }
    const glm::dvec3 extent = centroids.size();
    const glm::dvec3 facing = 0.5 * glm::length(extent) * normals.size();
    int axis = 0;
    double widest = -1.0;
    for (int k = 0; k < 6; ++k) {
        const double width = k < 3 ? extent[k] : facing[k - 3];
        if (width > widest) {
            widest = width;
            axis = k;
        }
    }
    const auto key = [&](std::uint32_t t) {
        return axis < 3 ? triangles_[t].centroid()[axis] : triangles_[t].normal[axis - 3];
    };
    const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
    std::nth_element(list.begin(), middle, list.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double ka = key(a), kb = key(b);
        return ka != kb ? ka < kb : a < b;
    });
    const std::uint32_t left = build({list.begin(), middle});
    return join(left, build({middle, list.end()}));
}

std::uint32_t EmitterTree::join(std::uint32_t left, std::uint32_t right) {
    const EmitterNode &a = nodes_[left], &b = nodes_[right];
    EmitterNode node{};
    node.power = a.power + b.power;
    node.centre = a.centre + b.power / node.power * (b.centre - a.centre);
    node.radius =
        std::max(glm::distance(node.centre, a.centre) + a.radius, glm::distance(node.centre, b.centre) + b.radius);
    const glm::dvec3 axis = a.power * a.axis + b.power * b.axis;
    const double length = glm::length(axis);
    node.axis = length > 0.0 ? axis / length : a.axis;
    const auto spreadOf = [&](const EmitterNode& child) {
        const Angle turned{glm::dot(node.axis, child.axis), glm::length(glm::cross(node.axis, child.axis))};
        return Angle{child.spreadCosine, child.spreadSine}.plus(turned);
    };
    const Angle ofA = spreadOf(a), ofB = spreadOf(b);
    const Angle& spread = ofA.cosine < ofB.cosine ? ofA : ofB;
    node.spreadCosine = spread.cosine;
    node.spreadSine = spread.sine;
    for (std::size_t c = 0; c < 3; ++c) node.flux[c] = a.flux[c] + b.flux[c];
    node.left = left;
    node.right = right;
    nodes_.push_back(node);
    nodeGroup_.push_back(nodeGroup_[left]);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
}

void EmitterTree::cut(const ReceiverPlane& plane, std::vector<EmitterTerminal>& terminals) const {
    terminals.clear();
    thread_local std::vector<Opened> heap;
    heap.clear();
    double value = 0.0, error = 0.0;
    const auto push = [&](std::uint32_t index) {
        Reckoning reckoned = reckon(nodes_[index], plane);
        if (!(reckoned.most > 0.0)) return;
        if (nodes_[index].isTriangle()) {
            const EmitterTriangle& t = triangleOf(nodes_[index]);
            if (glm::dot(plane.centre - t.corners[0], t.normal) <= -plane.radius) return;
            reckoned.error = 0.0;
        }
        value += reckoned.value;
        error += reckoned.error;
        heap.push_back({reckoned, index});
        std::push_heap(heap.begin(), heap.end());
    };
    for (const std::uint32_t root : roots_) push(root);
    const std::size_t most = std::max(kMostTerminals, roots_.size());
    while (!heap.empty() && heap.front().reckoned.error > 0.0 && heap.size() < most && error > kCutError * value) {
        std::pop_heap(heap.begin(), heap.end());
        const Opened opened = heap.back();
        heap.pop_back();
        value -= opened.reckoned.value;
        error -= opened.reckoned.error;
        push(nodes_[opened.node].left);
        push(nodes_[opened.node].right);
    }
    for (const Opened& o : heap) terminals.push_back({o.node, !nodes_[o.node].isTriangle() && !o.reckoned.asPoint});
    // Neighbours in the tree follow each other.
    std::sort(terminals.begin(), terminals.end(),
              [](const EmitterTerminal& a, const EmitterTerminal& b) { return a.node < b.node; });
}

EmitterTree::Choice EmitterTree::choose(std::uint32_t index, const ReceiverPlane& point, double u) const {
    Choice choice{kNone, 1.0};
    while (!nodes_[index].isTriangle()) {
        const EmitterNode& node = nodes_[index];
        const double left = reckon(nodes_[node.left], point).most;
        const double right = reckon(nodes_[node.right], point).most;
        if (!(left + right > 0.0)) return choice;
        const double share = left / (left + right);
        const bool first = u < share;
        u = std::clamp(first ? u / share : (u - share) / (1.0 - share), 0.0, 1.0);
        choice.probability *= first ? share : 1.0 - share;
        index = first ? node.left : node.right;
    }
    choice.triangle = nodes_[index].right;
    return choice;
}

std::uint32_t EmitterTree::chooseFar(std::uint32_t index, const glm::dvec3& point, double u) const {
    const auto sent = [&](std::uint32_t child) {
        const glm::dvec3 way = point - nodes_[index].centre;
        const auto& flux = nodes_[child].flux;
        return std::max(0.0, glm::dot(flux[0] + flux[1] + flux[2], way));
    };
    while (!nodes_[index].isTriangle()) {
        const EmitterNode& node = nodes_[index];
        const double left = sent(node.left), right = sent(node.right);
        const double share = left + right > 0.0 ? left / (left + right) : 0.5;
        const bool first = u < share;
        u = std::clamp(first ? u / share : (u - share) / (1.0 - share), 0.0, 1.0);
        index = first ? node.left : node.right;
    }
    return nodes_[index].right;
}

} // namespace lambert
