#include "meshing/hidden_patches.h"

#include "core/parallel.h"
#include "meshing/patch_offset.h"
#include "meshing/plane_frame.h"
#include "meshing/prepare.h"
#include "meshing/side_points.h"
#include "scene/box_index.h"
#include "scene/surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lambert {

namespace {

constexpr float kInward = 0.1F;        ///< from a patch's border to its centroid, where it is looked at
constexpr double kOpposed = -0.999999; ///< cosine between faces that touch

/// Looks at one patch after the other.
class Looker {
public:
    Looker(const RayCaster& rays, const PatchMesh& mesh, const PatchOptics& optics, const BoxIndex& index)
        : rays_(rays),
          scene_(rays.scene()),
          mesh_(mesh),
          optics_(optics),
          index_(index),
          tolerance_(2.0F * weldTolerance(rays.scene())) {}

    bool isHidden(std::size_t patch) {
        setPoints(patch);
        const glm::vec3 normal = mesh_.normal[patch];
        const bool touched = isTouched(patch);
        if (!touched && optics_.emittedRadiosity[patch] != Rgb(0.0F)) return false;
        const float offset = patchOriginOffset(rays_, mesh_, patch);
        return seesBacksAlone(patch, normal, offset) || (touched && seesBacksAlone(patch, -normal, offset));
    }

private:
    /// The centroid, and points of the border moved inward.
    void setPoints(std::size_t patch) {
        points_.assign(1, mesh_.centroid[patch]);
        const int count = mesh_.cornerCount(patch);
        for (int k = 0; k < count; ++k) {
            const glm::vec3 a = mesh_.position(patch, k), b = mesh_.position(patch, (k + 1) % count);
            points_.push_back(glm::mix(a, points_[0], kInward));
            points_.push_back(glm::mix(0.5F * (a + b), points_[0], kInward));
        }
    }

    /// Whether faces that face the patch lie on it everywhere.
    bool isTouched(std::size_t patch) {
        return std::all_of(points_.begin(), points_.end(), [&](const glm::vec3& point) {
            index_.meeting(Bounds{point, point}.grownBy(tolerance_), found_);
            return std::any_of(found_.begin(), found_.end(), [&](std::uint32_t other) {
                return other != mesh_.polygon[patch] && touches(other, point, glm::dvec3(mesh_.normal[patch]));
            });
        });
    }

    bool touches(std::uint32_t index, const glm::vec3& point, const glm::dvec3& normal) const {
        const Polygon& polygon = scene_.polygons[index];
        if (isOccluder(scene_, polygon) || hasHoles(scene_, polygon)) return false;
        const PlaneFrame frame = planeFrame(scene_, polygon);
        if (glm::dot(frame.normal(), normal) > kOpposed) return false;
        const auto tolerance = static_cast<double>(tolerance_);
        return std::abs(frame.height(point)) <= tolerance &&
               depthInside(frame.outline(scene_, polygon), frame.project(point)) >= -tolerance;
    }

    /// Whether all rays to one side meet black backs.
    bool seesBacksAlone(std::size_t patch, const glm::vec3& side, float offset) {
        for (std::uint32_t point = 0; point < points_.size(); ++point) {
            aimPacket(side, static_cast<std::uint32_t>(patch), point, packet_);
            rays_.closest(points_[point] + offset * side, packet_);
            for (int lane = 0; lane < RayPacket::kSize; ++lane)
                if (!isBlackBack(packet_.polygon[lane], packet_.facing[lane]) && !liesOnBlackBack(lane)) return false;
        }
        return true;
    }

    bool isBlackBack(std::uint32_t polygon, float facing) const {
        return polygon != kNone && facing >= 0.0F && scene_.polygons[polygon].backMaterial == kNone &&
               !isOccluder(scene_, scene_.polygons[polygon]);
    }

    /// Whether the front that a ray has met touches another: from the inside of that one, either may be met.
    bool liesOnBlackBack(int lane) {
        const std::uint32_t polygon = packet_.polygon[lane];
        if (polygon == kNone || packet_.facing[lane] >= 0.0F) return false;
        const glm::vec3 point = polygonPoint(scene_, polygon, packet_.u[lane], packet_.v[lane]);
        const glm::dvec3 normal = planeFrame(scene_, scene_.polygons[polygon]).normal();
        index_.meeting(Bounds{point, point}.grownBy(tolerance_), found_);
        return std::any_of(found_.begin(), found_.end(), [&](std::uint32_t other) {
            return other != polygon && isBlackBack(other, 0.0F) && touches(other, point, normal);
        });
    }

    const RayCaster& rays_;
    const Scene& scene_;
    const PatchMesh& mesh_;
    const PatchOptics& optics_;
    const BoxIndex& index_;
    float tolerance_;
    std::vector<glm::vec3> points_;
    std::vector<std::uint32_t> found_;
    RayPacket packet_;
};

} // namespace

std::vector<bool> findHiddenPatches(const RayCaster& rays, const PatchMesh& mesh, const PatchOptics& optics) {
    std::vector<Bounds> boxes;
    for (const Polygon& polygon : rays.scene().polygons) boxes.push_back(boundsOf(rays.scene(), polygon));
    const BoxIndex index(std::move(boxes));
    std::vector<char> hidden(mesh.size(), 0); // of threads' own, which bits are not
    parallelFor(mesh.size(), 256, [&](std::size_t begin, std::size_t end, int) {
        Looker looker(rays, mesh, optics, index);
        for (std::size_t patch = begin; patch < end; ++patch) hidden[patch] = looker.isHidden(patch) ? 1 : 0;
    });
    return {hidden.begin(), hidden.end()};
}

} // namespace lambert
