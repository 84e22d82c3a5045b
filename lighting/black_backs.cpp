#include "lighting/black_backs.h"

#include "formfactors/hemicube_face.h"
#include "formfactors/matrix_quality.h"
#include "formfactors/viewpoints.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace lambert {

namespace {

constexpr double kTold = 0.01;  ///< share from which backs are looked at, and told of
constexpr int kSamples = 256;   ///< hemicubes that look which backs are met
constexpr int kResolution = 16; ///< of these
constexpr int kPlaces = 4;      ///< of these on a patch: some may lie under what stands on it

bool emits(const PatchOptics& optics, std::size_t patch) { return sumOf(RgbSum(optics.emittedRadiosity[patch])) > 0.0; }

/// Where the rays of some places end that meet backs; sums over the places of the parts of each.
struct Ends {
    std::vector<double> met; ///< #materials, on their black backs
    double apart = 0.0;      ///< on occluders, or from a place that sees nothing but backs

    /// One place sees these parts of its hemisphere. What emits is never taken for the inside of something.
    void add(const std::vector<double>& backs, double occluders, bool emits) {
        const double onBacks = std::accumulate(backs.begin(), backs.end(), 0.0);
        if (!(onBacks + occluders > 0.0)) return;
        if (onBacks > kCovered && !emits) {
            apart += onBacks + occluders;
            return;
        }
        for (std::size_t m = 0; m < met.size(); ++m) met[m] += backs[m];
        apart += occluders;
    }
};

/// Looks from places on patches, with a hemicube each.
class Lookout {
public:
    Lookout(const PatchMesh& mesh, const PatchOptics& optics, const RayCaster& rays)
        : mesh_(mesh), optics_(optics), rays_(rays) {}

    void look(std::uint32_t patch, int place, Ends& ends) const {
        const Viewpoint from = viewpoint(mesh_, rays_, patch, place, {.perPatch = kPlaces});
        const glm::vec3 normal = mesh_.normal[patch];
        std::vector<double> backs(ends.met.size(), 0.0);
        double occluders = 0.0;
        double all = 0.0;
        RayPacket packet;
        for (const HemicubeFace& face : hemicubeFaces(normal, from.angle, kResolution)) {
            for (int row = 0; row < face.rows; row += 4) {
                for (int column = 0; column < face.columns; column += 4) {
                    tileDirections(face, column, row, kResolution, packet);
                    rays_.closest(from.origin, packet);
                    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
                        const glm::dvec3 d(packet.directionX[lane], packet.directionY[lane], packet.directionZ[lane]);
                        const double length2 = glm::dot(d, d);
                        const double weight = glm::dot(d, glm::dvec3(normal)) / (length2 * length2);
                        all += weight;
                        if (packet.polygon[lane] == kNone || packet.facing[lane] < 0.0F) continue;
                        const Polygon& polygon = rays_.scene().polygons[packet.polygon[lane]];
                        if (polygon.backMaterial != kNone) continue;
                        (isOccluder(rays_.scene(), polygon) ? occluders : backs[polygon.material]) += weight;
                    }
                }
            }
        }
        for (double& part : backs) part /= all;
        ends.add(backs, occluders / all, emits(optics_, patch));
    }

private:
    const PatchMesh& mesh_;
    const PatchOptics& optics_;
    const RayCaster& rays_;
};

/// One of the shares, as it is found: of the weights of open patches, what their rays to backs carry.
struct Share {
    std::vector<double> loss; ///< #patches
    double lost = 0.0, of = 0.0;

    double value() const { return of > 0.0 ? lost / of : 0.0; }
};

/// `weight`: per m² of each patch.
template <typename Weight>
Share shareOf(const PatchMesh& mesh, const RadiositySolution& solution, Weight&& weight) {
    Share share;
    share.loss.assign(mesh.size(), 0.0);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const double back = solution.covered[i];
        const double own = static_cast<double>(mesh.area[i]) * weight(i, back > kCovered);
        share.of += own;
        share.lost += share.loss[i] = own * back;
    }
    return share;
}

/// Where the lost light ends: from places on patches that lose it, each chosen as often as its loss asks for.
Ends endsOf(const Share& share, const Lookout& lookout, std::size_t materials) {
    Ends ends{std::vector<double>(materials, 0.0)};
    double upTo = 0.0;
    int taken = 0;
    for (std::uint32_t patch = 0; patch < share.loss.size() && taken < kSamples; ++patch) {
        upTo += share.loss[patch];
        for (int place = 0; taken < kSamples && upTo > (taken + 0.5) / kSamples * share.lost; ++taken)
            lookout.look(patch, place++ % kPlaces, ends);
    }
    return ends;
}

} // namespace

BlackBacks findBlackBacks(const PatchMesh& mesh, const PatchOptics& optics, const RayCaster& rays,
                          const RadiositySolution& solution) {
    std::array shares{
        shareOf(mesh, solution, [](std::size_t, bool covered) { return covered ? 0.0 : 1.0; }),
        // A lamp in a box of backs is covered too, but its light counts; what else is covered is dark.
        shareOf(mesh, solution,
                [&](std::size_t i, bool covered) {
                    return covered && !emits(optics, i) ? 0.0 : sumOf(solution.radiosity[i]);
                }),
        shareOf(mesh, solution, [&](std::size_t i, bool) { return sumOf(RgbSum(optics.emittedRadiosity[i])); }),
    };
    shares[1].of = sumOf(solution.energy.emitted + solution.energy.received);
    BlackBacks result;
    const std::array<double*, 3> values{&result.rays, &result.light, &result.emission};
    const Lookout lookout(mesh, optics, rays);
    double largest = 0.0;
    for (std::size_t k = 0; k < shares.size(); ++k) {
        *values[k] = shares[k].value();
        if (*values[k] <= kTold) continue;
        const Ends ends = endsOf(shares[k], lookout, rays.scene().materials.size());
        const double met = std::accumulate(ends.met.begin(), ends.met.end(), 0.0);
        *values[k] *= met > 0.0 ? met / (met + ends.apart) : 0.0;
        if (!(*values[k] > largest)) continue;
        largest = *values[k];
        const auto most = std::max_element(ends.met.begin(), ends.met.end());
        result.material = rays.scene().materials[static_cast<std::size_t>(most - ends.met.begin())].name;
    }
    return result;
}

std::optional<std::string> warningOf(const BlackBacks& backs) {
    const double largest = std::max({backs.rays, backs.light, backs.emission});
    if (largest <= kTold) return std::nullopt;
    const char* const what = largest == backs.emission ? "of what the lights give off falls on"
                             : largest == backs.light  ? "of all light ends on"
                                                       : "of the rays meet";
    return fmt::format("{:.1f} % {} black back faces, most of them of material \"{}\": turn its polygons, or make it "
                       "two-sided (--two-sided, or \"two_sided\" in an overrides file)",
                       100.0 * largest, what, backs.material);
}

} // namespace lambert
