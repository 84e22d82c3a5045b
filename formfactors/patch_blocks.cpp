#include "formfactors/patch_blocks.h"

#include "core/box.h"
#include "core/vector_clones.h"
#include "formfactors/patch_shape.h"
#include "formfactors/quadrature.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace lambert {

namespace {

constexpr int kLanes = PatchBlocks::kLanes;
constexpr int kPoints = PatchBlocks::kPoints;
constexpr std::size_t kAlone = 8; ///< polygons of so many patches share no block with others

/// Of the sum of two radii to the distance. A rule of order n errs by about the 2n-th power: see gaussOrder.
constexpr float kMidpointRatio = 0.03F;
constexpr float kGaussRatio = 0.2F;
/// Pairs cut by a plane are small from here on: the part in front is found well enough by points that count or not.
constexpr float kCutRatio = 0.05F;
constexpr float kSmallest = 1e-12F;
/// Squared sine of the angle between planes that count as parallel: faces that meet so see less than 1e-5 of each other.
constexpr float kRoundedSine = 1e-5F;

float radiusOf(const PatchMesh& mesh, std::size_t patch) {
    float radius = 0.0F;
    for (int k = 0; k < mesh.cornerCount(patch); ++k)
        radius = std::max(radius, glm::distance(mesh.position(patch, k), mesh.centroid[patch]));
    return radius;
}

std::vector<WeightedPoint> gaussPoints(const PatchMesh& mesh, std::size_t patch) {
    std::vector<WeightedPoint> points;
    appendGaussPoints(polygonOf(mesh, patch).points(), 2, points);
    return points;
}

/// Orders patches so that every 16 of them lie close together.
void groupNeighbours(const PatchMesh& mesh, std::span<std::uint32_t> patches) {
    if (patches.size() <= kLanes) return;
    Box<glm::vec3> box;
    for (const std::uint32_t patch : patches) box.add(mesh.centroid[patch]);
    const glm::vec3 extent = box.size();
    const int axis = extent.x >= std::max(extent.y, extent.z) ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::size_t half = std::max<std::size_t>(patches.size() / 2 / kLanes, 1) * kLanes;
    std::nth_element(patches.begin(), patches.begin() + static_cast<std::ptrdiff_t>(half), patches.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         return std::pair(mesh.centroid[a][axis], a) < std::pair(mesh.centroid[b][axis], b);
                     });
    groupNeighbours(mesh, patches.first(half));
    groupNeighbours(mesh, patches.subspan(half));
}

/// Kinds, and the factors by the rule of one point.
LAMBERT_VECTOR_CLONES
bool byMidpoints(const PatchBlocks::Viewer& viewer, const PatchBlocks::Block& block, float tolerance,
                 PatchBlocks::Factors& result) {
    const glm::vec3 x = viewer.centre;
    const glm::vec3 n = viewer.normal;
    std::uint32_t more = 0; // lanes that need the next rule
    for (int lane = 0; lane < kLanes; ++lane) {
        const float dx = block.centreX[lane] - x.x;
        const float dy = block.centreY[lane] - x.y;
        const float dz = block.centreZ[lane] - x.z;
        const float squared = dx * dx + dy * dy + dz * dz;
        const float inverse = squared > 0.0F ? 1.0F / squared : 1e30F;
        const float here = n.x * dx + n.y * dy + n.z * dz; // height of the patch over the viewer's plane
        const float there =
            -(block.normalX[lane] * dx + block.normalY[lane] * dy + block.normalZ[lane] * dz); // and the other way
        const float parallel = n.x * block.normalX[lane] + n.y * block.normalY[lane] + n.z * block.normalZ[lane];
        const float squaredSine = 1.0F - parallel * parallel;
        const float sine = squaredSine > kRoundedSine ? std::sqrt(squaredSine) : 0.0F;
        const float hereReach = block.radius[lane] * sine;
        const float thereReach = viewer.radius * sine;
        const bool seen = block.area[lane] > 0.0F && here + hereReach > tolerance && there + thereReach > tolerance;
        const bool cut = here < hereReach + tolerance || there < thereReach + tolerance;
        const float ratio = (viewer.radius + block.radius[lane]) * std::sqrt(inverse);
        const float value = here > 0.0F && there > 0.0F ? (here * inverse) * (there * inverse) * block.area[lane] *
                                                              (1.0F / std::numbers::pi_v<float>)
                                                        : 0.0F;
        const bool near = ratio > kGaussRatio || (cut && ratio > kCutRatio);
        result.factor[lane] = seen ? value : 0.0F;
        result.kind[lane] = !seen ? PatchBlocks::kUnseen : near ? PatchBlocks::kNear : PatchBlocks::kDone;
        more |= seen && !near && (cut || ratio > kMidpointRatio) ? 1U : 0U;
    }
    return more != 0;
}

/// The factors by the rule of 2 × 2 points on either side.
LAMBERT_VECTOR_CLONES
void byGaussPoints(const PatchBlocks::Viewer& viewer, const PatchBlocks::Block& block, PatchBlocks::Factors& result) {
    float sum[kLanes] = {};
    const glm::vec3 n = viewer.normal;
    for (int a = 0; a < kPoints; ++a) {
        const glm::vec3 x = viewer.points[static_cast<std::size_t>(a)];
        const float weight = viewer.weights[static_cast<std::size_t>(a)];
        for (int b = 0; b < kPoints; ++b) {
            for (int lane = 0; lane < kLanes; ++lane) {
                const float dx = block.pointX[b][lane] - x.x;
                const float dy = block.pointY[b][lane] - x.y;
                const float dz = block.pointZ[b][lane] - x.z;
                const float squared = dx * dx + dy * dy + dz * dz;
                const float inverse = squared > 0.0F ? 1.0F / squared : 0.0F;
                const float here = n.x * dx + n.y * dy + n.z * dz;
                const float there = -(block.normalX[lane] * dx + block.normalY[lane] * dy + block.normalZ[lane] * dz);
                const float value = (here > 0.0F ? here * inverse : 0.0F) * (there > 0.0F ? there * inverse : 0.0F);
                sum[lane] += weight * block.weight[b][lane] * value;
            }
        }
    }
    constexpr float scale = 1.0F / std::numbers::pi_v<float>;
    for (int lane = 0; lane < kLanes; ++lane)
        result.factor[lane] = result.kind[lane] == PatchBlocks::kDone ? scale * sum[lane] : 0.0F;
}

} // namespace

PatchBlocks::Viewer::Viewer(const PatchMesh& mesh, std::size_t patch)
    : centre(mesh.centroid[patch]), normal(mesh.normal[patch]), radius(radiusOf(mesh, patch)) {
    const auto gauss = gaussPoints(mesh, patch);
    double sum = 0.0;
    for (std::size_t k = 0; k < gauss.size(); ++k) {
        points[k] = glm::vec3(gauss[k].point);
        sum += gauss[k].weight;
    }
    for (std::size_t k = 0; k < gauss.size(); ++k) weights[k] = static_cast<float>(gauss[k].weight / sum);
}

PatchBlocks::Viewer::Viewer(const glm::vec3& point, const glm::vec3& unitNormal) : centre(point), normal(unitNormal) {
    points.fill(point);
    weights.fill(1.0F / kPoints);
}

PatchBlocks::PatchBlocks(const PatchMesh& mesh) : blockOf_(mesh.size()) {
    const auto sameSurface = [&](std::uint32_t a, std::uint32_t b) {
        return mesh.polygon[a] == mesh.polygon[b] && mesh.isBack(a) == mesh.isBack(b);
    };
    std::vector<std::uint32_t> order(mesh.size());
    std::iota(order.begin(), order.end(), 0U);
    std::size_t begun = 0; // patches from here on are in no block yet
    const auto fill = [&](std::size_t end) {
        for (; begun < end; begun += kLanes)
            addBlock(mesh, std::span(order).subspan(begun, std::min<std::size_t>(kLanes, end - begun)));
        begun = end;
    };
    for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
        while (last < order.size() && sameSurface(order[first], order[last])) ++last;
        if (last - first < kAlone) continue;
        fill(first);
        groupNeighbours(mesh, std::span(order).subspan(first, last - first));
        fill(last);
    }
    fill(order.size());
}

void PatchBlocks::addBlock(const PatchMesh& mesh, std::span<const std::uint32_t> patches) {
    Block& block = blocks_.emplace_back();
    block.count = static_cast<std::uint32_t>(patches.size());
    Box<glm::vec3> box;
    block.flat = true;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const bool used = lane < patches.size();
        const std::uint32_t patch = used ? patches[lane] : patches.back();
        block.patch[lane] = patch;
        blockOf_[patch] = static_cast<std::uint32_t>(blocks_.size() - 1);
        const glm::vec3 c = mesh.centroid[patch];
        const glm::vec3 n = mesh.normal[patch];
        block.centreX[lane] = c.x;
        block.centreY[lane] = c.y;
        block.centreZ[lane] = c.z;
        block.normalX[lane] = n.x;
        block.normalY[lane] = n.y;
        block.normalZ[lane] = n.z;
        block.radius[lane] = radiusOf(mesh, patch);
        const auto gauss = gaussPoints(mesh, patch);
        double area = 0.0;
        for (std::size_t k = 0; k < kPoints; ++k) {
            block.pointX[k][lane] = static_cast<float>(gauss[k].point.x);
            block.pointY[k][lane] = static_cast<float>(gauss[k].point.y);
            block.pointZ[k][lane] = static_cast<float>(gauss[k].point.z);
            block.weight[k][lane] = used ? static_cast<float>(gauss[k].weight) : 0.0F;
            area += gauss[k].weight;
        }
        block.area[lane] = used ? static_cast<float>(area) : 0.0F;
        for (int k = 0; k < mesh.cornerCount(patch); ++k) box.add(mesh.position(patch, k));
        block.flat = block.flat && mesh.polygon[patch] == mesh.polygon[patches[0]] &&
                     mesh.isBack(patch) == mesh.isBack(patches[0]);
    }
    block.centre = 0.5F * (box.lower + box.upper);
    block.reach = 0.5F * glm::distance(box.lower, box.upper);
}

bool PatchBlocks::factors(const Viewer& viewer, const Block& block, float tolerance, Factors& result) {
    const glm::vec3 way = block.centre - viewer.centre;
    if (glm::dot(viewer.normal, way) + block.reach <= tolerance) return false;
    if (block.flat) {
        const glm::vec3 normal(block.normalX[0], block.normalY[0], block.normalZ[0]);
        const glm::vec3 toViewer = viewer.centre - glm::vec3(block.centreX[0], block.centreY[0], block.centreZ[0]);
        if (glm::dot(normal, toViewer) + viewer.radius <= tolerance) return false;
    }
    if (byMidpoints(viewer, block, tolerance, result)) byGaussPoints(viewer, block, result);
    bool any = false;
    for (int lane = 0; lane < kLanes; ++lane) {
        if (result.kind[lane] == kDone && !(result.factor[lane] > kSmallest)) result.kind[lane] = kUnseen;
        any = any || result.kind[lane] != kUnseen;
    }
    return any;
}

} // namespace lambert
