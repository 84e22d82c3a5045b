#include "formfactors/hemisphere.h"

#include "core/error.h"
#include "core/orthonormal_basis.h"
#include "core/vector_clones.h"
#include "core/warps.h"
#include "formfactors/hit_sum.h"
#include "formfactors/viewpoints.h"

#include <fmt/format.h>

namespace lambert {

namespace {

LAMBERT_VECTOR_CLONES
void turnedDirections(const OrthonormalBasis& basis, const glm::vec3* local, RayPacket& packet) {
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        const glm::vec3 d = local[lane];
        packet.directionX[lane] = d.x * basis.x.x + d.y * basis.y.x + d.z * basis.z.x;
        packet.directionY[lane] = d.x * basis.x.y + d.y * basis.y.y + d.z * basis.z.y;
        packet.directionZ[lane] = d.x * basis.x.z + d.y * basis.y.z + d.z * basis.z.z;
        packet.active[lane] = -1;
    }
}

} // namespace

Hemisphere::Hemisphere(const PatchMesh& mesh, const RayCaster& rays, const ViewOptions& options)
    : mesh_(mesh), rays_(rays), options_(options) {
    const int r = options.resolution;
    if (r < 4 || r > 4096 || r % 4 != 0)
        throw UsageError(fmt::format("hemisphere resolution: found {}, allowed are multiples of 4 from 4 to 4096", r));
    checkPerPatch(options.perPatch);
    for (int row = 0; row < r; row += 4)
        for (int column = 0; column < r; column += 4)
            for (int cell = 0; cell < RayPacket::kSize; ++cell)
                directions_.emplace_back(
                    cosineHemisphere((glm::dvec2(column + cell % 4, row + cell / 4) + 0.5) / static_cast<double>(r)));
}

std::uint64_t Hemisphere::raysPerRow() const {
    return directions_.size() * static_cast<std::uint64_t>(options_.perPatch);
}

void Hemisphere::row(std::uint32_t patch, RowAccumulator& accumulator) const {
    for (int k = 0; k < options_.perPatch; ++k)
        addHemisphere(viewpoint(mesh_, rays_, patch, k, options_), mesh_.normal[patch], accumulator);
}

void Hemisphere::pointRow(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index,
                          RowAccumulator& accumulator) const {
    for (int k = 0; k < options_.perPatch; ++k)
        addHemisphere({origin, viewAngle(index, k, options_)}, normal, accumulator);
}

void Hemisphere::addHemisphere(const Viewpoint& view, const glm::vec3& normal, RowAccumulator& accumulator) const {
    const double weight = 1.0 / static_cast<double>(raysPerRow());
    const OrthonormalBasis basis(normal, view.angle);
    RayPacket packet;
    HitSum sum(mesh_.lookup, accumulator);
    for (std::size_t first = 0; first < directions_.size(); first += RayPacket::kSize) {
        turnedDirections(basis, directions_.data() + first, packet);
        rays_.closest(view.origin, packet);
        sum.add(packet, RayPacket::kSize, weight);
    }
}

} // namespace lambert
