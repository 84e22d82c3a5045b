#include "scene/mgf/shapes.h"

#include "scene/scene.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

/// A right-handed frame whose w is the axis.
struct Frame {
    glm::dvec3 origin, u, v, w;

    /// An axis and its opposite give the same circles of points if the number of segments is even.
    Frame(const glm::dvec3& from, const glm::dvec3& axis) : origin(from), w(glm::normalize(axis)) {
        constexpr double kTie = 0.01; // nearly equal components must not choose by their rounding
        int smallest = 0;
        for (int k = 1; k < 3; ++k)
            if (std::abs(w[k]) < std::abs(w[smallest]) - kTie) smallest = k;
        glm::dvec3 helper(0.0);
        helper[smallest] = 1.0;
        u = glm::normalize(glm::cross(helper, w));
        v = glm::cross(w, u);
    }
};

/// A point of the curve that is turned about the axis.
struct ProfilePoint {
    double radius; //!< >= 0; exactly 0 is one point on the axis
    double height; //!< along the axis
};

/// Surface of revolution; its front is to the right of the profile where the axis points up.
class Lathe {
public:
    Lathe(const Frame& frame, std::vector<ProfilePoint> profile, int segments)
        : profile_(std::move(profile)), segments_(static_cast<std::uint32_t>(segments)) {
        for (const ProfilePoint& point : profile_) {
            first_.push_back(static_cast<std::uint32_t>(result_.points.size()));
            const glm::dvec3 centre = frame.origin + point.height * frame.w;
            for (std::uint32_t i = 0; i < (isPole(point) ? 1 : segments_); ++i) {
                const double angle = glm::two_pi<double>() * i / segments_;
                result_.points.push_back(centre +
                                         point.radius * (std::cos(angle) * frame.u + std::sin(angle) * frame.v));
            }
        }
    }

    /// `closed`: the last point of the profile is joined to the first.
    Facets run(bool closed) {
        for (std::size_t k = 0; k + 1 < profile_.size(); ++k) addBand(k, k + 1);
        if (closed) addBand(profile_.size() - 1, 0);
        return std::move(result_);
    }

private:
    static bool isPole(const ProfilePoint& point) { return point.radius == 0.0; }
    std::uint32_t at(std::size_t k, std::uint32_t i) const {
        return isPole(profile_[k]) ? first_[k] : first_[k] + i % segments_;
    }

    void addBand(std::size_t lower, std::size_t upper) {
        const bool flat = profile_[lower].height == profile_[upper].height;
        if (flat && isPole(profile_[upper])) { // a disc: two triangles at a time are a quad
            for (std::uint32_t i = 0; i < segments_; i += 2)
                result_.faces.push_back({at(upper, 0), at(lower, i), at(lower, i + 1), at(lower, i + 2)});
            return;
        }
        for (std::uint32_t i = 0; i < segments_; ++i) {
            if (isPole(profile_[lower])) {
                result_.faces.push_back({at(lower, 0), at(upper, i + 1), at(upper, i), kNone});
            } else if (isPole(profile_[upper])) {
                result_.faces.push_back({at(lower, i), at(lower, i + 1), at(upper, 0), kNone});
            } else {
                result_.faces.push_back({at(lower, i), at(lower, i + 1), at(upper, i + 1), at(upper, i)});
            }
        }
    }

    std::vector<ProfilePoint> profile_;
    std::uint32_t segments_;
    std::vector<std::uint32_t> first_; //!< of each profile point, into the points
    Facets result_;
};

/// The surface of the profile, or with its other side to the front.
Facets turned(const Frame& frame, std::vector<ProfilePoint> profile, int segments, bool inward, bool closed) {
    if (inward) std::reverse(profile.begin(), profile.end());
    return Lathe(frame, std::move(profile), segments).run(closed);
}

} // namespace

Facets sphereFacets(const glm::dvec3& centre, double radius, int segments) {
    const int bands = segments / 2;
    const double size = std::abs(radius);
    std::vector<ProfilePoint> profile{{0.0, -size}};
    for (int k = 1; k < bands; ++k) {
        const double angle = glm::pi<double>() * k / bands;
        profile.push_back({size * std::sin(angle), -size * std::cos(angle)});
    }
    profile.push_back({0.0, size});
    return turned(Frame(centre, {0, 0, 1}), std::move(profile), segments, radius < 0.0, false);
}

Facets coneFacets(const glm::dvec3& from, double fromRadius, const glm::dvec3& to, double toRadius, int segments) {
    return turned(Frame(from, to - from), {{std::abs(fromRadius), 0.0}, {std::abs(toRadius), glm::distance(from, to)}},
                  segments, fromRadius + toRadius < 0.0, false);
}

Facets ringFacets(const glm::dvec3& centre, const glm::dvec3& normal, double inner, double outer, int segments) {
    return turned(Frame(centre, normal), {{outer, 0.0}, {inner, 0.0}}, segments, false, false);
}

Facets torusFacets(const glm::dvec3& centre, const glm::dvec3& normal, double inner, double outer, int segments) {
    const int around = std::max(4, segments / 2); // of the tube, whose circle is the smaller one
    const double middle = 0.5 * std::abs(inner + outer);
    const double tube = 0.5 * std::abs(outer - inner);
    std::vector<ProfilePoint> profile;
    for (int k = 0; k < around; ++k) {
        const double angle = glm::two_pi<double>() * k / around;
        // The innermost point of a torus without a hole is on the axis: exactly, or it would not be a pole.
        const bool onAxis = inner == 0.0 && 2 * k == around;
        profile.push_back({onAxis ? 0.0 : middle + tube * std::cos(angle), tube * std::sin(angle)});
    }
    return turned(Frame(centre, normal), std::move(profile), segments, inner + outer < 0.0, true);
}

} // namespace lambert
