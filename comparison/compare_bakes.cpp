#include "comparison/compare_bakes.h"

#include "core/error.h"
#include "scene/rays/line_caster.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace lambert {

namespace {

constexpr double kMostUnmatched = 0.01; ///< of the area; edges of fine patches

const std::vector<RgbSum>& lightOf(const StoredSolution& solution, Quantity quantity) {
    return quantity == Quantity::Radiosity ? solution.solution.radiosity : solution.solution.irradiance;
}

bool samePatches(const MeshedScene& a, const MeshedScene& b) {
    return a.scene->origin == b.scene->origin && a.mesh.frontCount == b.mesh.frontCount &&
           a.mesh.corners == b.mesh.corners && a.mesh.positions == b.mesh.positions;
}

/// Of what a line to the centre of a patch crosses the patch on the same side; kNone if there is none. Where surfaces touch, that
/// which is a front, or a second side, as the patch is.
std::uint32_t patchAmong(std::span<const Crossing> crossings, const PatchMesh& mesh, bool front) {
    std::uint32_t found = kNone;
    for (const Crossing& crossing : crossings) {
        std::uint32_t patch = mesh.lookup.patchAt(crossing.polygon, crossing.u, crossing.v);
        if (!crossing.front) patch = mesh.lookup.backPatch(crossing.polygon, patch);
        if (patch != kNone && crossing.front == front) return patch;
        if (found == kNone) found = patch;
    }
    return found;
}

/// The patch of `other` at the centre of each patch of `reference` and on the same side; kNone where there is none.
std::vector<std::uint32_t> patchesAtCentres(const MeshedScene& reference, const MeshedScene& other) {
    const PatchMesh& mesh = reference.mesh;
    const glm::vec3 shift = placeInScene(*other.scene, reference.scene->origin);
    std::vector<std::uint32_t> result(mesh.size(), kNone);
    if (other.scene->polygons.empty()) return result;
    const RayCaster rays(*other.scene);
    const LineCaster lines(*other.scene);
    LinePacket packet;
    LineCrossings crossings;
    constexpr std::size_t kLanes = LinePacket::kSize;
    for (std::size_t first = 0; first < mesh.size(); first += kLanes) {
        const std::size_t lanes = std::min(kLanes, mesh.size() - first);
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const std::size_t i = first + std::min(lane, lanes - 1);
            const float above = 4.0F * rays.originOffset(std::sqrt(mesh.area[i])); // centres are off by rounding
            const glm::vec3 origin = mesh.centroid[i] + shift + above * mesh.normal[i];
            const glm::vec3 direction = -2.0F * above * mesh.normal[i];
            packet.originX[lane] = origin.x;
            packet.originY[lane] = origin.y;
            packet.originZ[lane] = origin.z;
            packet.directionX[lane] = direction.x;
            packet.directionY[lane] = direction.y;
            packet.directionZ[lane] = direction.z;
            packet.active[lane] = lane < lanes ? -1 : 0;
        }
        lines.cross(packet, crossings);
        for (std::size_t lane = 0; lane < lanes; ++lane)
            result[first + lane] =
                patchAmong(crossings.of(static_cast<int>(lane)), other.mesh, first + lane < mesh.frontCount);
    }
    return result;
}

} // namespace

BakeComparison compareBakes(const StoredSolution& reference, const StoredSolution& other, Quantity quantity) {
    const PatchMesh& mesh = reference.meshed.mesh;
    BakeComparison result;
    result.samePatches = samePatches(reference.meshed, other.meshed);
    std::vector<std::uint32_t> patchOf;
    if (!result.samePatches) patchOf = patchesAtCentres(reference.meshed, other.meshed);

    std::vector<double> area, mean[2], channel[2][3];
    double all = 0.0, unmatched = 0.0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const auto weight = static_cast<double>(mesh.area[i]);
        const std::size_t j = result.samePatches ? i : patchOf[i];
        all += weight;
        result.difference.push_back(0.0F);
        result.excess.push_back(0.0F);
        if (j == kNone) {
            unmatched += weight;
            continue;
        }
        area.push_back(weight);
        const std::array<RgbSum, 2> light{lightOf(reference, quantity)[i], lightOf(other, quantity)[j]};
        for (std::size_t side = 0; side < 2; ++side) {
            for (int c = 0; c < 3; ++c) channel[side][c].push_back(light[side][c]);
            mean[side].push_back((light[side].x + light[side].y + light[side].z) / 3.0);
        }
        const RgbSum off = glm::abs(light[1] - light[0]);
        result.difference.back() = static_cast<float>((off.x + off.y + off.z) / 3.0);
        result.excess.back() = static_cast<float>(mean[1].back() - mean[0].back());
    }
    result.unmatchedArea = unmatched / all;
    if (!(result.unmatchedArea <= kMostUnmatched))
        throw InputError(fmt::format("the two are of different scenes: at {:.3g} % of the area of A, B has no surface",
                                     100.0 * result.unmatchedArea));
    for (std::size_t c = 0; c < 3; ++c) result.channels[c] = fieldErrors(area, channel[0][c], channel[1][c]);
    result.overall = fieldErrors(area, mean[0], mean[1]);
    return result;
}

} // namespace lambert
