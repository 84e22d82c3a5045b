#pragma once

#include "formfactors/convex_polygon.h"
#include "formfactors/extents.h"
#include "formfactors/occluders.h"
#include "meshing/patch_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lambert {

/// A polygon that receives light: a patch, a polygon that only blocks, or a part of either.
struct Target {
    ConvexPolygon polygon;
    Plane plane; //!< unit normal, to the front
    glm::dvec3 centre{0.0};
    double radius = 0.0;      //!< of the corners around the centre
    double opacity = 1.0;     //!< share that is not a hole
    std::uint32_t patch;      //!< what its front is; kNone: black
    bool frontHidden = false; //!< something stands against it
    bool blackBack = false;   //!< its back is no patch, and not hidden
};

/// Targets in groups of eight neighbours, laid out for vector code, in a tree.
class PatchClusters {
public:
    static constexpr std::size_t kLanes = 8;
    static constexpr int kHighestOrder = 4;

    /// All targets of the clusters [first, last).
    struct Node {
        Extents extents;                   ///< of the corners
        std::uint32_t first, last;         ///< clusters
        std::uint32_t left = 0, right = 0; ///< children; 0: a leaf of one cluster
    };

    /// Gauss points of eight targets, an even number: point k of lane l at [k][l].
    struct Points {
        std::vector<std::array<double, kLanes>> x, y, z, weight; ///< weights in m²; 0 in lanes without a target
    };

    struct Cluster {
        std::array<std::uint32_t, kLanes> target; ///< into targets(); the last one is repeated in lanes without
        std::uint32_t count;                      ///< lanes with a target
        std::array<double, kLanes> normalX, normalY, normalZ;
        Extents extents;   ///< of the corners
        glm::dvec3 centre; ///< of a sphere around the targets' centres
        double spread;     ///< its radius
        double radius;     ///< the largest of the targets' radii
        Plane plane;       ///< that all targets lie in and face, if `flat`
        bool flat;
        std::array<Points, kHighestOrder> points; ///< by order − 1
    };

    /// Points within `tolerance` (metres) of a plane count as in it; targets in an occluder's plane take that.
    PatchClusters(const Scene& scene, const PatchMesh& mesh, const Occluders& occluders, Directions& directions,
                  double tolerance);

    /// Patches first, in their order and whole; then what else receives light. In the clusters are, instead of targets
    /// of which something covers a part, their parts.
    const std::vector<Target>& targets() const { return targets_; }
    const std::vector<Cluster>& clusters() const { return clusters_; }
    const std::vector<Node>& nodes() const { return nodes_; } ///< the root first; empty without targets

private:
    std::uint32_t build(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end, double normalWeight);
    void takePlane(Target& target, const Plane& plane) const;
    std::vector<std::uint32_t> divideAtContacts(const std::vector<std::uint32_t>& occluderOf,
                                                const Occluders& occluders);
    void addCluster(const std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end);

    std::span<const glm::dvec3> directions_;
    double tolerance_;
    std::vector<Target> targets_;
    std::vector<Cluster> clusters_;
    std::vector<Node> nodes_;
};

} // namespace lambert
