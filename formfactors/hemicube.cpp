#include "formfactors/hemicube.h"

#include "core/error.h"
#include "core/orthonormal_basis.h"
#include "core/vector_clones.h"
#include "formfactors/block_cover.h"
#include "formfactors/hit_sum.h"

#include <fmt/format.h>

#include <numbers>
#include <optional>

namespace lambert {

namespace {

/// Rays per polygon from which on it pays (measured on rooms of 500 and 2700 polygons) to look for blocks of pixels that need none.
constexpr std::uint64_t kRaysPerPolygon = 24;

/// Delta form factor of a pixel on a hemicube of side 2, per area of the pixel: Cohen, Greenberg 1985.
double deltaFormFactor(bool top, double u, double v) {
    const double d = u * u + v * v + 1.0;
    return (top ? 1.0 : v) / (std::numbers::pi * d * d);
}

} // namespace

std::array<HemicubeFace, 5> hemicubeFaces(const glm::vec3& normal, float angle, int resolution) {
    const OrthonormalBasis basis(normal, angle);
    const glm::vec3 t = basis.x;
    const glm::vec3 b = basis.y;
    const int half = resolution / 2;
    return {{{normal, t, b, resolution, resolution, true},
             {t, b, normal, resolution, half, false},
             {b, -t, normal, resolution, half, false},
             {-t, -b, normal, resolution, half, false},
             {-b, t, normal, resolution, half, false}}};
}

LAMBERT_VECTOR_CLONES
void tileDirections(const HemicubeFace& face, int column, int row, int resolution, RayPacket& packet) {
    const float step = 2.0F / static_cast<float>(resolution);
    const float u0 = -1.0F + 0.5F * step;
    const float v0 = face.top ? u0 : 0.5F * step;
    const glm::vec3 a = face.axis;
    const glm::vec3 b = face.axisU;
    const glm::vec3 c = face.axisV;
    const int columns = face.columns;
    const int rows = face.rows;
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        const int pixelColumn = column + (lane & 3);
        const int pixelRow = row + (lane >> 2);
        const float u = u0 + static_cast<float>(pixelColumn) * step;
        const float v = v0 + static_cast<float>(pixelRow) * step;
        packet.directionX[lane] = a.x + u * b.x + v * c.x;
        packet.directionY[lane] = a.y + u * b.y + v * c.y;
        packet.directionZ[lane] = a.z + u * b.z + v * c.z;
        packet.active[lane] = pixelColumn < columns && pixelRow < rows ? -1 : 0;
    }
}

Hemicube::Hemicube(const PatchMesh& mesh, const RayCaster& rays, const ViewOptions& options)
    : mesh_(mesh), rays_(rays), fewPolygons_(false), options_(options) {
    const int r = options.resolution;
    if (r < 4 || r > 4096 || r % 2 != 0)
        throw UsageError(fmt::format("hemicube resolution: found {}, allowed are even numbers from 4 to 4096", r));
    checkPerPatch(options.perPatch);
    fewPolygons_ =
        raysPerRow() / static_cast<std::uint64_t>(options.perPatch) >= kRaysPerPolygon * rays.scene().polygons.size();
    topTiles_ = makeTiles(r, true);
    sideTiles_ = makeTiles(r, false);
    double sum = 0.0;
    for (const Tile& tile : topTiles_) sum += tile.sum;
    for (const Tile& tile : sideTiles_) sum += 4.0 * tile.sum;
    for (std::vector<Tile>* tiles : {&topTiles_, &sideTiles_}) {
        for (Tile& tile : *tiles) {
            tile.sum = 0.0;
            for (float& w : tile.weight) {
                w = static_cast<float>(static_cast<double>(w) / sum);
                tile.sum += static_cast<double>(w);
            }
        }
    }
}

std::vector<Hemicube::Tile> Hemicube::makeTiles(int resolution, bool top) {
    const double step = 2.0 / resolution;
    const int rows = top ? resolution : resolution / 2;
    std::vector<Tile> tiles;
    for (int row = 0; row < rows; row += 4) {
        for (int column = 0; column < resolution; column += 4) {
            Tile tile{};
            for (int lane = 0; lane < RayPacket::kSize; ++lane) {
                const int pixelColumn = column + lane % 4;
                const int pixelRow = row + lane / 4;
                if (pixelColumn >= resolution || pixelRow >= rows) continue;
                const double u = -1.0 + (pixelColumn + 0.5) * step;
                const double v = (top ? -1.0 : 0.0) + (pixelRow + 0.5) * step;
                tile.weight[lane] = static_cast<float>(step * step * deltaFormFactor(top, u, v));
                tile.sum += static_cast<double>(tile.weight[lane]);
            }
            tiles.push_back(tile);
        }
    }
    return tiles;
}

std::uint64_t Hemicube::raysPerRow() const {
    const auto r = static_cast<std::uint64_t>(options_.resolution);
    return 3 * r * r * static_cast<std::uint64_t>(options_.perPatch);
}

Viewpoint Hemicube::viewpoint(std::uint32_t patch, int index) const {
    return lambert::viewpoint(mesh_, rays_, patch, index, options_);
}

void Hemicube::row(std::uint32_t patch, RowAccumulator& accumulator) const {
    for (int k = 0; k < options_.perPatch; ++k) {
        const Viewpoint view = viewpoint(patch, k);
        addHemicube(view.origin, mesh_.normal[patch], view.angle, accumulator);
    }
    accumulator.scale(1.0 / options_.perPatch);
}

void Hemicube::pointRow(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index,
                        RowAccumulator& accumulator) const {
    for (int k = 0; k < options_.perPatch; ++k) addHemicube(origin, normal, viewAngle(index, k, options_), accumulator);
    accumulator.scale(1.0 / options_.perPatch);
}

void Hemicube::addHemicube(const glm::vec3& origin, const glm::vec3& normal, float angle,
                           RowAccumulator& accumulator) const {
    HitSum sum(mesh_.lookup, accumulator);
    std::optional<BlockCover> cover;
    if (fewPolygons_) cover.emplace(rays_.scene(), origin);
    for (const HemicubeFace& face : hemicubeFaces(normal, angle, options_.resolution))
        cover ? addCoveredFace(face, origin, *cover, sum) : addFace(face, origin, sum);
}

void Hemicube::addFace(const HemicubeFace& face, const glm::vec3& origin, HitSum& sum) const {
    RayPacket packet;
    const Tile* tile = face.top ? topTiles_.data() : sideTiles_.data();
    for (int row = 0; row < face.rows; row += 4) {
        for (int column = 0; column < face.columns; column += 4, ++tile) {
            tileDirections(face, column, row, options_.resolution, packet);
            rays_.closest(origin, packet);
            sum.add(packet, tile->weight, tile->sum);
        }
    }
}

void Hemicube::addCoveredFace(const HemicubeFace& face, const glm::vec3& origin, BlockCover& cover, HitSum& sum) const {
    cover.face(face, options_.resolution);
    RayPacket packet;
    const Tile* tile = face.top ? topTiles_.data() : sideTiles_.data();
    for (int row = 0; row < face.rows; row += 4) {
        for (int column = 0; column < face.columns; column += 4, ++tile) {
            if (const std::uint32_t polygon = cover.polygonAt(column, row); polygon != kNone) {
                cover.hits(polygon, column, row, packet);
            } else {
                tileDirections(face, column, row, options_.resolution, packet);
                rays_.closest(origin, packet);
            }
            sum.add(packet, tile->weight, tile->sum);
        }
    }
}

} // namespace lambert
