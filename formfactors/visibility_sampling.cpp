#include "formfactors/visibility_sampling.h"

#include "core/error.h"
#include "core/random.h"
#include "formfactors/closed_form.h"
#include "formfactors/hit_sum.h"
#include "formfactors/local_lines.h"
#include "formfactors/near_exchange.h"
#include "formfactors/pair_rays.h"
#include "meshing/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

constexpr double kQuadratureError = 5e-4; ///< of a row's sum, by the rules of PatchBlocks
/// The mean error of the share that n rays find visible where some are blocked is about kSpread n^−kRate: the rays of a pair
/// are spread evenly over both patches. The rate is that of an edge across four dimensions, the factor a guess from the Cornell
/// box; both only choose the first number of rays, and further rounds mend what they miss.
constexpr double kSpread = 0.12;
constexpr double kRate = 0.625;
constexpr std::size_t kMostBlocks = 4096; ///< of which pairs are tested, to know what is hidden before any ray
/// Of lines through the hemisphere to that of independent ones: they are spread evenly.
constexpr double kLineVariance = 0.25;
constexpr double kLineNoise = 0.02; ///< of the share that kRemainderLines find: two and a half standard errors at most
constexpr double kDoubt = 3.0;      ///< rows of so many times the error asked for are looked at again
constexpr double kDisagreement = 4.0; ///< standard errors of a count
constexpr int kMostRounds = 4;
constexpr std::uint32_t kMostRaysPerPair = 1U << 20;
constexpr std::uint32_t kRunLength = 16;  ///< neighbouring pairs that are judged together
constexpr std::uint32_t kRaysToJudge = 3; ///< per pair, at least

Plane planeOf(const PatchMesh& mesh, std::size_t patch) {
    // Of the corners in double: the normal is rounded to single precision.
    const glm::dvec3 areaVector = polygonAreaVector(polygonOf(mesh, patch).points());
    const double length = glm::length(areaVector);
    return Plane::through(glm::dvec3(mesh.centroid[patch]),
                          length > 0.0 ? areaVector / length : glm::dvec3(mesh.normal[patch]));
}

} // namespace

/// The computation of one row.
class VisibilitySampling::Row {
public:
    struct ClearPair {
        std::uint32_t patch;
        float factor;
    };
    /// Keeps its memory from row to row.
    struct Scratch {
        std::vector<PairSample> pairs;
        std::vector<ClearPair> clear;
        ExchangeScratch exchange;
    };

    Row(const VisibilitySampling& method, const PatchBlocks::Viewer& viewer, const PatchShape& shape,
        std::uint32_t index, std::uint32_t patch, Scratch& scratch)
        : method_(method),
          viewer_(viewer),
          shape_(shape),
          index_(index),
          patch_(patch),
          pairs_(scratch.pairs),
          clear_(scratch.clear),
          exchange_(scratch.exchange) {
        pairs_.clear();
        clear_.clear();
        if (patch_ != kNone) {
            polygon_ = polygonOf(method.mesh_, patch_);
            plane_ = planeOf(method.mesh_, patch_);
            area_ = glm::length(polygonAreaVector(polygon_.points()));
        }
    }

    /// `lines` through the hemisphere, for F_back and F_out.
    void run(const std::vector<Ray>& lines, RowAccumulator& accumulator) {
        traceLines(lines);
        if (lineFront_ > 0.0) {
            findPairs();
            PairRays rays(method_.rays_, shape_, method_.shapes_);
            pilot(rays);
            sample(rays);
            if (isDoubtful()) countNearPairs();
            method_.raysTraced_ += rays.traced();
        }
        method_.raysTraced_ += lines.size();
        ++method_.rowsDone_;
        close(accumulator);
    }

private:
    void findPairs() {
        PatchBlocks::Factors factors;
        const std::vector<PatchBlocks::Block>& blocks = method_.blocks_.blocks();
        for (std::uint32_t b = 0; b < blocks.size(); ++b) {
            const PatchBlocks::Block& block = blocks[b];
            if (!PatchBlocks::factors(viewer_, block, method_.tolerance_, factors)) continue;
            const Blocking known = visibilityOf(b);
            if (known == Blocking::Hidden) continue;
            for (std::uint32_t lane = 0; lane < block.count; ++lane) {
                if (factors.kind[lane] == PatchBlocks::kUnseen) continue;
                const std::uint32_t patch = block.patch[lane];
                const bool near = factors.kind[lane] == PatchBlocks::kNear;
                double factor = near ? nearFactor(patch) : static_cast<double>(factors.factor[lane]);
                if (!method_.mesh_.opacity.empty()) factor *= static_cast<double>(method_.mesh_.opacity[patch]);
                if (!(factor > 0.0)) continue;
                if (known == Blocking::Clear) {
                    clear_.push_back({patch, static_cast<float>(factor)});
                    clearSum_ += static_cast<double>(clear_.back().factor);
                    continue;
                }
                PairSample pair;
                pair.patch = patch;
                pair.weighted = near;
                pair.factor = static_cast<float>(factor);
                pairs_.push_back(pair);
            }
        }
    }

    Blocking visibilityOf(std::uint32_t block) const {
        if (patch_ == kNone || !method_.known_) return Blocking::Unknown;
        return method_.known_->between(polygon_, plane_, method_.blocks_.blockOf(patch_), block);
    }

    double nearFactor(std::uint32_t patch) const {
        const auto t = static_cast<double>(method_.tolerance_);
        const ConvexPolygon to = polygonOf(method_.mesh_, patch);
        if (patch_ == kNone) return pointToPolygon(glm::dvec3(viewer_.centre), glm::dvec3(viewer_.normal), to.points());
        if (patch == patch_) return 0.0;
        if (cornerHeights(plane_, to.points())[1] <= t) return 0.0;
        const Plane toPlane = planeOf(method_.mesh_, patch);
        if (cornerHeights(toPlane, polygon_.points())[1] <= t) return 0.0;
        ConvexPolygon fromPart, toPart, behind;
        split(polygon_, toPlane, t, fromPart, behind);
        split(to, plane_, t, toPart, behind);
        if (fromPart.empty() || toPart.empty()) return 0.0;
        return nearExchange(fromPart, plane_, toPart, toPlane, exchange_) / area_;
    }

    void traceLines(const std::vector<Ray>& lines) {
        const std::uint32_t front = 0, back = 1, out = 2;
        std::uint32_t count[3] = {};
        RayPacket packet;
        RayOrigins origins;
        for (std::size_t first = 0; first < lines.size(); first += RayPacket::kSize) {
            const int used = static_cast<int>(std::min<std::size_t>(RayPacket::kSize, lines.size() - first));
            for (int lane = 0; lane < RayPacket::kSize; ++lane) {
                const Ray& line = lines[first + static_cast<std::size_t>(std::min(lane, used - 1))];
                origins.set(lane, line.origin);
                packet.aim(lane, line.direction, lane < used);
            }
            method_.rays_.closest(origins, packet);
            for (int lane = 0; lane < used; ++lane) {
                const bool met = packet.polygon[lane] != kNone;
                const bool isFront =
                    met && (packet.facing[lane] < 0.0F ||
                            method_.rays_.scene().polygons[packet.polygon[lane]].backMaterial != kNone);
                ++count[isFront ? front : met ? back : out];
            }
        }
        const auto all = static_cast<double>(lines.size());
        lineFront_ = count[front] / all;
        lineBack_ = count[back] / all;
        lineOut_ = count[out] / all;
    }

    /// A few rays per pair, which only tell where visibility is mixed.
    void pilot(PairRays& rays) {
        const double perFactor = std::clamp(8.0 / method_.options_.error, 256.0, 1e6);
        for (PairSample& pair : pairs_) {
            pair.shift = shiftOf(pair.patch, 0);
            const double wanted = std::ceil(static_cast<double>(pair.factor) * perFactor);
            pair.wanted = static_cast<std::uint32_t>(std::clamp(wanted, pair.weighted ? 4.0 : 1.0, 4096.0));
        }
        rays.trace(pairs_);
        for (std::size_t first = 0; first < pairs_.size(); first += kRunLength)
            judge(std::span(pairs_).subspan(first, std::min<std::size_t>(kRunLength, pairs_.size() - first)), rays);
        for (PairSample& pair : pairs_) pair.restart(shiftOf(pair.patch, 1));
    }

    /// Which pairs of a run are mixed: in a run of which some rays are blocked, those and the neighbours of those of which
    /// some are.
    static void judge(std::span<PairSample> run, PairRays& rays) {
        std::uint32_t visible = 0, all = 0;
        for (const PairSample& pair : run) {
            visible += pair.visible;
            all += pair.rays;
        }
        if (visible == 0 || visible == all) return;
        std::array<std::uint32_t, kRunLength> few;
        for (std::size_t k = 0; k < run.size(); ++k) {
            few[k] = run[k].wanted;
            run[k].wanted = std::max(few[k], kRaysToJudge);
        }
        rays.trace(run);
        const auto isBlocked = [&](std::size_t k) { return run[k].visible < run[k].rays; };
        const auto isVisible = [&](std::size_t k) { return run[k].visible > 0; };
        for (std::size_t k = 0; k < run.size(); ++k) {
            bool blocked = false, free = false;
            for (std::size_t n = k - std::min<std::size_t>(k, 1); n < std::min(k + 2, run.size()); ++n) {
                blocked = blocked || isBlocked(n);
                free = free || isVisible(n);
            }
            run[k].mixed = blocked && free;
            run[k].wanted = few[k];
        }
    }

    /// Fresh rays: as many as the first ones where these agree, else as many as the error asks for.
    void sample(PairRays& rays) {
        double atStake = 0.0;
        for (const PairSample& pair : pairs_)
            if (pair.mixed) atStake += std::pow(static_cast<double>(pair.factor), 1.0 - kRate * 2.0 / 3.0);
        double scale = std::pow(kSpread * atStake / method_.options_.error, 1.0 / kRate);
        double others = 0.0, mixed = 0.0;
        for (const PairSample& pair : pairs_) {
            if (pair.mixed)
                mixed += std::pow(static_cast<double>(pair.factor), 2.0 / 3.0);
            else
                others += pair.wanted;
        }
        const double room = std::max(0.0, method_.options_.mostRaysPerRow - others);
        for (int round = 0; round < kMostRounds; ++round) {
            const double bounded = mixed > 0.0 ? std::min(scale, room / mixed) : scale;
            for (PairSample& pair : pairs_) {
                if (!pair.mixed) continue;
                const double wanted = std::ceil(bounded * std::pow(static_cast<double>(pair.factor), 2.0 / 3.0));
                pair.wanted = static_cast<std::uint32_t>(std::clamp(
                    wanted, static_cast<double>(std::max(2U, pair.wanted)), static_cast<double>(kMostRaysPerPair)));
            }
            rays.trace(pairs_);
            assess();
            if (error_ <= method_.options_.error || bounded < scale || !(mixed > 0.0)) break;
            scale *= std::min(16.0, std::pow(1.1 * error_ / method_.options_.error, 1.0 / kRate));
        }
    }

    /// Σ_j F_ij, and what its halves by even and odd rays tell of its error.
    void assess() {
        sum_ = clearSum_;
        variance_ = error_ = 0.0;
        for (const PairSample& pair : pairs_) {
            const double factor = pair.factor;
            sum_ += factor * pair.visibleShare();
            const double deviation = 0.5 * factor * (pair.half(0) - pair.half(1));
            variance_ += deviation * deviation;
            error_ += std::abs(deviation);
        }
    }

    /// Whether the row is far from what was asked for, or its pairs and its lines disagree.
    bool isDoubtful() const {
        const double disagreement = std::max(0.0, std::abs(lineFront_ - sum_) - kLineNoise);
        return error_ + disagreement > kDoubt * method_.options_.error;
    }

    /// Two patches in a narrow gap exchange light between points that face each other, which rays between any points of both
    /// hardly ever meet: what lines through the hemisphere count takes their place.
    void countNearPairs() {
        if (std::none_of(pairs_.begin(), pairs_.end(), [](const PairSample& pair) { return pair.weighted; })) return;
        thread_local RowAccumulator counts(0);
        thread_local FormFactorRow counted;
        if (counts.back() != method_.mesh_.size()) counts = RowAccumulator(method_.mesh_.size());
        if (patch_ == kNone)
            method_.moreLines_.pointRow(viewer_.centre, viewer_.normal, index_, counts);
        else
            method_.moreLines_.row(patch_, counts);
        counts.take(counted);
        method_.raysTraced_ += kMoreLines;
        lineBack_ = counted.back;
        lineOut_ = counted.out;
        lineFront_ = std::max(0.0, 1.0 - lineBack_ - lineOut_);
        lines_ = kMoreLines;
        auto entry = counted.entries.begin();
        std::sort(pairs_.begin(), pairs_.end(),
                  [](const PairSample& a, const PairSample& b) { return a.patch < b.patch; });
        for (PairSample& pair : pairs_) {
            if (!pair.weighted) continue;
            while (entry != counted.entries.end() && entry->patch < pair.patch) ++entry;
            const bool isHit = entry != counted.entries.end() && entry->patch == pair.patch;
            const double value = isHit ? entry->value : 0.0;
            const double noise =
                std::sqrt(kLineVariance * std::max(value * (1.0 - value), 1.0 / kMoreLines) / kMoreLines);
            const double factor = pair.factor;
            const double deviation = 0.5 * factor * std::abs(pair.half(0) - pair.half(1));
            const double disagreement = std::abs(value - factor * pair.visibleShare());
            // Rays that agree among themselves may all have missed the gap.
            if (deviation > noise || disagreement > kDisagreement * noise) pair.setCounted(value, noise);
        }
        assess();
    }

    void close(RowAccumulator& accumulator) {
        const double lineRemainder = lineBack_ + lineOut_;
        const double quadrature = kQuadratureError * kQuadratureError * sum_ * sum_;
        double target = 1.0;
        if (lineRemainder > 0.0) {
            const auto n = static_cast<double>(lines_);
            const double lineVariance = kLineVariance * std::max(lineFront_ * lineRemainder, 1.0 / n) / n;
            const double pairVariance = variance_ + quadrature;
            target = std::min(1.0, (sum_ * lineVariance + lineFront_ * pairVariance) / (lineVariance + pairVariance));
        }
        if (!(sum_ > 0.0)) target = 0.0;
        // The correction goes where the error is: into the pairs by their variances, and evenly into what the rules leave.
        const double uneven = variance_ > 0.0 ? variance_ / (variance_ + quadrature) : 0.0;
        const double perVariance = variance_ > 0.0 ? uneven * (target - sum_) / variance_ : 0.0;
        const auto corrected = [&](const PairSample& pair) {
            const double factor = pair.factor;
            const double deviation = 0.5 * factor * (pair.half(0) - pair.half(1));
            return std::clamp(factor * pair.visibleShare() + perVariance * deviation * deviation, 0.0, factor);
        };
        double sum = clearSum_;
        for (const PairSample& pair : pairs_) sum += corrected(pair);
        const double rescale = sum > 0.0 ? target / sum : 0.0;
        double total = 0.0;
        const auto add = [&](std::uint32_t patch, double value) {
            if (!(value > 0.0)) return;
            accumulator.add(patch, value);
            total += value;
        };
        for (const ClearPair& pair : clear_) add(pair.patch, rescale * static_cast<double>(pair.factor));
        for (const PairSample& pair : pairs_) add(pair.patch, rescale * corrected(pair));
        const double remainder = std::max(0.0, 1.0 - total);
        if (lineRemainder > 0.0) {
            if (lineBack_ > 0.0) accumulator.add(accumulator.back(), remainder * lineBack_ / lineRemainder);
            if (lineOut_ > 0.0) accumulator.add(accumulator.out(), remainder * lineOut_ / lineRemainder);
        } else if (!(total > 0.0)) {
            accumulator.add(accumulator.back(), remainder);
        }
        // What was moved to close the row was wrong before, and may be in the wrong place now.
        accumulator.setError(std::max(error_ + std::abs(target - sum), std::abs(target - sum_)));
    }

    std::array<std::uint32_t, 4> shiftOf(std::uint32_t patch, std::uint32_t phase) const {
        return philox({index_, patch, phase, patch_ == kNone ? 0x50545649U : 0x56495349U}, method_.options_.seed);
    }

    const VisibilitySampling& method_;
    const PatchBlocks::Viewer& viewer_;
    const PatchShape& shape_;
    std::uint32_t index_; ///< of the random numbers
    std::uint32_t patch_; ///< kNone: a point
    ConvexPolygon polygon_;
    Plane plane_;
    double area_ = 0.0;              ///< m², holes included
    std::vector<PairSample>& pairs_; ///< whose visibility rays are to find
    std::vector<ClearPair>& clear_;
    ExchangeScratch& exchange_; ///< what nothing stands before
    double clearSum_ = 0.0;
    std::uint32_t lines_ = kRemainderLines;
    double lineFront_ = 0.0, lineBack_ = 0.0, lineOut_ = 0.0; ///< shares of the lines
    double sum_ = 0.0, variance_ = 0.0, error_ = 0.0;
};

VisibilitySampling::VisibilitySampling(const PatchMesh& mesh, const RayCaster& rays,
                                       const VisibilitySamplingOptions& options)
    : mesh_(mesh),
      rays_(rays),
      options_(options),
      tolerance_(2.0F * weldTolerance(rays.scene())),
      lines_(mesh, rays, {.lines = kRemainderLines, .seed = options.seed}),
      moreLines_(mesh, rays, {.lines = kMoreLines, .seed = options.seed + 1}),
      blocks_(mesh) {
    if (!(options.error >= 1e-5 && options.error <= 0.5))
        throw UsageError(fmt::format("form-factor error: found {}, allowed are 1e-5 to 0.5", options.error));
    if (blocks_.blocks().size() <= kMostBlocks)
        known_.emplace(rays.scene(), mesh, blocks_, static_cast<double>(tolerance_));
    shapes_.reserve(mesh.size());
    for (std::size_t patch = 0; patch < mesh.size(); ++patch) shapes_.emplace_back(rays, mesh, patch);
}

std::uint64_t VisibilitySampling::raysPerRow() const {
    const std::uint64_t rows = rowsDone_;
    return rows > 0 ? raysTraced_ / rows : mesh_.size() + kRemainderLines;
}

void VisibilitySampling::row(std::uint32_t patch, RowAccumulator& accumulator) const {
    thread_local Row::Scratch scratch;
    Row(*this, PatchBlocks::Viewer(mesh_, patch), shapes_[patch], patch, patch, scratch)
        .run(lines_.lines(patch), accumulator);
}

void VisibilitySampling::pointRow(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index,
                                  RowAccumulator& accumulator) const {
    thread_local Row::Scratch scratch;
    Row(*this, PatchBlocks::Viewer(origin, normal), PatchShape(origin, normal), index, kNone, scratch)
        .run(lines_.lines(origin, normal, index), accumulator);
}

} // namespace lambert
