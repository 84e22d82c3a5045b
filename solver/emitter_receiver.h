#pragma once

#include "core/spherical_triangle.h"
#include "scene/rays/ray_caster.h"
#include "solver/emitter_tree.h"
#include "solver/solution.h"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lambert {

/// Direct light of emitters at one point after the other of a plane, from the same terminals of the emitters' tree. One per plane;
/// on each thread one at a time.
///
/// Every terminal of a ray's share or more has rays of its own, which find what share of it is seen. Of the others, all together,
/// rays find the share β that is seen; what they would send unhindered counts β times, and the rays add only in what way those that
/// are seen differ from all: where nothing is hidden there is no noise.
class EmitterReceiver {
public:
    /// `lift` (metres): rays begin so far above the plane. `key`: of the random numbers.
    EmitterReceiver(const EmitterTree& tree, const RayCaster& rays, const ReceiverPlane& plane, float lift,
                    std::uint64_t key);

    bool isDark() const { return terminals().empty(); } //!< nothing shines on the plane

    /// Adds what comes from each group, times `weight`, to `sums`, #groups, by about so many rays.
    void gather(const glm::vec3& point, std::uint32_t rays, double weight, std::span<RgbSum> sums);

    /// Whether not all rays from all points had the same answer.
    bool seesParts() const { return partly_ || (someSeen_ && someHidden_); }

private:
    static constexpr int kLanes = ShadowPacket::kSize;

    /// Points of the unit square, each of which fills a gap of those before it, from anywhere on: the plastic number's Kronecker
    /// sequence.
    class PlanePoints {
    public:
        explicit PlanePoints(const glm::dvec2& start) : at_(start) {}
        glm::dvec2 next();

    private:
        glm::dvec2 at_;
    };

    /// A triangle, or a node as good as a point, as one point sees it.
    struct Source {
        double value;           ///< F B_e over the channels, if all of it is seen
        RgbSum irradiance;      ///< the same per channel
        std::uint32_t node;     ///< where it is as good as a point: kNone for a triangle
        std::uint32_t triangle; ///< kNone for a node
        std::uint32_t group;
        std::array<glm::dvec3, 3> corners; ///< of a triangle, above the horizon
    };
    /// What rays are to find out together: the share that is seen, by weight.
    struct Question {
        RgbSum irradiance; ///< if all is seen
        std::uint32_t group;
        bool isOfFew; ///< stands for the sources of less than a ray's share, all such ones for as much
        double all = 0.0, seen = 0.0;
    };
    struct Scratch {
        std::vector<EmitterTerminal> terminals;
        std::vector<Source> sources;
        std::vector<std::uint32_t> few; ///< sources that are less than a ray's share
        std::vector<Question> questions;
        std::vector<glm::dvec3> clipped;
    };
    static Scratch& scratch();
    static std::vector<EmitterTerminal>& terminals() { return scratch().terminals; }
    static std::vector<Question>& questions() { return scratch().questions; }

    void findSources();
    bool isPoint(const EmitterNode& triangle) const;
    void addPoint(const EmitterNode& node, std::uint32_t index, std::uint32_t triangle);
    void addTriangle(std::uint32_t index, double weight);
    void addVisible(std::uint32_t index, const EmitterTriangle& t, const std::array<glm::dvec3, 3>& corners,
                    double weight);
    void ask(std::uint32_t rays);
    void aimAt(const Source& s, std::uint32_t rays);
    void aimByDirection(const Source& s, const EmitterTriangle& t, const SphericalTriangle& seen, std::uint32_t rays);
    std::optional<SphericalTriangle> nearTriangle(const std::array<glm::dvec3, 3>& corners) const;
    void addRay(const EmitterTriangle& t, const glm::dvec3& target, double weight);
    void trace();
    void answer(double weight, std::span<RgbSum> sums);

    const EmitterTree& tree_;
    const RayCaster& rays_;
    ReceiverPlane plane_;
    double lift_;
    PlanePoints points_, choices_;
    glm::dvec3 point_{0.0};
    bool partly_ = false, someSeen_ = false, someHidden_ = false;
    ShadowPacket packet_;
    Ray last_{}; ///< of the packet
    double weight_[kLanes];
    std::uint32_t question_[kLanes];
    int pending_ = 0;
};

} // namespace lambert
