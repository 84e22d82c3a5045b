#include "meshing/near_contacts.h"

#include "core/box.h"
#include "core/parallel.h"
#include "meshing/contact_strips.h"
#include "meshing/plane_frame.h"
#include "meshing/prepare.h"
#include "meshing/weld.h"

#include <glm/common.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <span>

namespace lambert {

namespace {

constexpr double kWeld = 4.0; ///< in the tolerance of the scene's vertices: points of lines keep more than that apart

/// Patches along an outline, on all that show it.
double costOf(const Scene& scene, const Outline& outline, const StripOptions& options, int levels) {
    const PlaneFrame frame = planeFrame(scene, scene.polygons[outline.below]);
    std::vector<HoveringEdge> edges;
    for (const OutlineEdge& edge : outline.edges)
        edges.push_back({frame.project(glm::vec3(edge.from)), frame.project(glm::vec3(edge.to)), edge.gap, levels});
    return patchesAlong(edges, options) * (outline.hovering.empty() ? 1.0 : 2.0);
}

struct Chosen {
    const Outline* outline;
    int levels; ///< most strips on each side
};

/// Which outlines are followed, and how: all of emitters before any strips, and these before what does not emit; first those
/// along which most light leaves, or else the long ones, as along them most patches would lie across.
/// Of strips there are as many as the budget allows.
std::vector<Chosen> choose(const Scene& scene, const std::vector<Outline>& outlines, const StripOptions& options,
                           double budget) {
    const auto stake = [](const Outline& outline) {
        return outline.length * (outline.emission > 0.0 ? outline.emission : 1.0);
    };
    std::vector<std::size_t> order(outlines.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return stake(outlines[a]) > stake(outlines[b]); });
    std::vector<std::size_t> place(outlines.size(), outlines.size()); // in `chosen`
    std::vector<Chosen> chosen;
    for (const bool emits : {true, false}) {
        for (const bool strips : {false, true}) {
            for (const std::size_t i : order) {
                if ((outlines[i].emission > 0.0) != emits || (strips && place[i] == outlines.size())) continue;
                const double alone = costOf(scene, outlines[i], options, 0);
                if (!strips) {
                    if (alone > budget) continue;
                    budget -= alone;
                    place[i] = chosen.size();
                    chosen.push_back({&outlines[i], 0});
                    continue;
                }
                for (int levels = options.levels; levels > 0; --levels) {
                    const double more = costOf(scene, outlines[i], options, levels) - alone;
                    if (more > budget) continue;
                    budget -= more;
                    chosen[place[i]].levels = levels;
                    break;
                }
            }
        }
    }
    return chosen;
}

/// The edges that matter for a polygon, in its plane.
std::vector<HoveringEdge> edgesInPlane(const PlaneFrame& frame, std::span<const glm::dvec2> border,
                                       const std::vector<Chosen>& chosen, double length) {
    Box<glm::dvec2> near;
    for (const glm::dvec2& p : border) near.add(p);
    const auto [lower, upper] = near;
    std::vector<HoveringEdge> edges;
    for (const auto& [outline, levels] : chosen) {
        for (const OutlineEdge& edge : outline->edges) {
            const HoveringEdge flat{frame.project(glm::vec3(edge.from)), frame.project(glm::vec3(edge.to)), edge.gap,
                                    levels};
            const glm::dvec2 first = glm::min(flat.from, flat.to), last = glm::max(flat.from, flat.to);
            if (first.x > upper.x + length || last.x < lower.x - length || first.y > upper.y + length ||
                last.y < lower.y - length)
                continue;
            const auto same = std::find_if(edges.begin(), edges.end(), [&](const HoveringEdge& known) {
                return (known.from == flat.from && known.to == flat.to) ||
                       (known.from == flat.to && known.to == flat.from);
            });
            if (same == edges.end()) {
                edges.push_back(flat);
            } else {
                same->gap = std::min(same->gap, flat.gap);
                same->levels = std::max(same->levels, flat.levels);
            }
        }
    }
    return edges;
}

/// Numbers the points on borders: vertices of the scene where they are near enough, new ones elsewhere.
void addVertices(const Scene& scene, double tolerance, NearContacts& result) {
    std::vector<glm::vec3> points = scene.positions;
    for (NearContact& contact : result.contacts) {
        const PlaneFrame frame = planeFrame(scene, scene.polygons[contact.polygon]);
        for (std::size_t i = 0; i < contact.lines.points.size(); ++i)
            if (contact.lines.onBorder[i]) points.push_back(frame.lift(contact.lines.points[i]));
    }
    const std::vector<std::uint32_t> representative = weldPositions(points, static_cast<float>(tolerance));
    const std::size_t known = scene.positions.size();
    std::vector<std::uint32_t> index(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i < known || representative[i] != i) {
            index[i] = i < known ? static_cast<std::uint32_t>(i) : index[representative[i]];
            continue;
        }
        index[i] = static_cast<std::uint32_t>(known + result.vertices.size());
        result.vertices.push_back(points[i]);
    }
    std::size_t next = known;
    for (NearContact& contact : result.contacts)
        for (std::size_t i = 0; i < contact.lines.points.size(); ++i)
            if (contact.lines.onBorder[i]) contact.lines.vertices[i] = index[next++];
}

} // namespace

NearContactFinder::NearContactFinder(const Scene& scene, double length)
    : scene_(scene), length_(length), found_(findHoveringOutlines(scene, length)) {}

NearContacts NearContactFinder::find(double budget) const {
    NearContacts result;
    const double tolerance = kWeld * static_cast<double>(weldTolerance(scene_));
    const StripOptions options{length_, tolerance};
    std::map<std::uint32_t, std::vector<Chosen>> byPolygon;
    for (const Chosen& chosen : choose(scene_, found_.outlines, options, budget)) {
        byPolygon[chosen.outline->below].push_back(chosen);
        for (const std::uint32_t polygon : chosen.outline->hovering) byPolygon[polygon].push_back(chosen);
    }
    for (const auto& [polygon, chosen] : byPolygon) result.contacts.push_back({polygon, {}});
    parallelFor(result.contacts.size(), 1, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t i = begin; i < end; ++i) {
            const Polygon& polygon = scene_.polygons[result.contacts[i].polygon];
            const PlaneFrame frame = planeFrame(scene_, polygon);
            const std::vector<glm::dvec2> border = frame.outline(scene_, polygon);
            std::vector<std::pair<glm::dvec2, glm::dvec2>> touching;
            if (const auto it = found_.touching.find(result.contacts[i].polygon); it != found_.touching.end())
                for (const auto& [a, b] : it->second)
                    touching.emplace_back(frame.project(scene_.positions[a]), frame.project(scene_.positions[b]));
            result.contacts[i].lines =
                contactStrips(border, edgesInPlane(frame, border, byPolygon.at(result.contacts[i].polygon), length_),
                              touching, options);
        }
    });
    std::erase_if(result.contacts, [](const NearContact& contact) { return contact.lines.lines.empty(); });
    addVertices(scene_, tolerance, result);
    return result;
}

} // namespace lambert
