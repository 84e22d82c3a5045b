#pragma once

#include "meshing/patch_optics.h"
#include "scene/rays/ray_caster.h"
#include "solver/solution.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// A plane piece of what emits, facing counter-clockwise.
struct EmitterTriangle {
    std::array<glm::dvec3, 3> corners; //!< metres
    glm::dvec3 normal;                 //!< unit length
    double area;                       //!< m²
    RgbSum radiosity;                  //!< B_e, per m²; less where it has holes
    double lift;                       //!< rays end so far above it, metres
    std::uint32_t group;               //!< see EmitterTree::groups

    double power() const { return area * sumOf(radiosity); }
    glm::dvec3 centroid() const { return (corners[0] + corners[1] + corners[2]) / 3.0; }
    /// Of the circle about the centroid that holds it.
    double radius() const;
};

/// Triangles that emit, or one of them.
struct EmitterNode {
    glm::dvec3 centre;               //!< by power; of one triangle its centroid
    double radius;                   //!< of a ball about the centre that holds all
    glm::dvec3 axis;                 //!< unit length
    double spreadCosine, spreadSine; //!< of an angle than which no normal is turned farther from the axis
    std::array<glm::dvec3, 3> flux;  //!< per channel Σ A B_e n
    double power;                    //!< Σ A B_e over the channels
    std::uint32_t left, right;       //!< nodes; of one triangle: kNone, and the triangle

    bool isTriangle() const { return left == kNone; }
};

/// Where light is looked for: points of a plane.
struct ReceiverPlane {
    glm::dvec3 centre, normal;
    double radius; //!< no point lies farther from the centre; 0 for a single one
};

/// A node that is not looked into.
struct EmitterTerminal {
    std::uint32_t node;
    /// One of its triangles, chosen at random, has to stand for it; else it is one triangle, or as good as a point: all of it faces the
    /// receiver and lies above its horizon.
    bool sampled;
};

/// All that emits on a mesh, as a hierarchy: source polygons, of textured emitters and of polygons that are not emitting as a whole the
/// patches. Triangles of different materials have no node in common.
///
/// Lights as a tree that each receiver cuts: B. Walter et al., "Lightcuts: a scalable approach to illumination", SIGGRAPH 2005.
class EmitterTree {
public:
    EmitterTree(const RayCaster& rays, const PatchMesh& mesh, const PatchOptics& optics);

    std::span<const EmitterTriangle> triangles() const { return triangles_; }
    const EmitterNode& node(std::uint32_t index) const { return nodes_[index]; }
    const EmitterTriangle& triangleOf(const EmitterNode& node) const { return triangles_[node.right]; }
    /// The materials that emit, into Scene::materials, ascending.
    std::span<const std::uint32_t> groups() const { return groups_; }
    std::uint32_t groupOf(std::uint32_t node) const { return nodeGroup_[node]; }

    /// Nodes that hold all triangles which may shine on the plane once each, and so few that their number is bounded: opened until
    /// the error of taking them for points is a thousandth, or there are as many as may be.
    void cut(const ReceiverPlane& plane, std::vector<EmitterTerminal>& terminals) const;

    struct Choice {
        std::uint32_t triangle; //!< kNone if none of them shines on the point
        double probability;
    };
    /// A triangle of a node, by `u` in [0, 1), roughly in proportion to what it sends to a point.
    Choice choose(std::uint32_t node, const ReceiverPlane& point, double u) const;
    /// A triangle of a terminal that is not sampled, exactly in proportion to that.
    std::uint32_t chooseFar(std::uint32_t node, const glm::dvec3& point, double u) const;

private:
    void collect(const RayCaster& rays, const PatchMesh& mesh, const PatchOptics& optics);
    void addPatch(const RayCaster& rays, const PatchMesh& mesh, std::size_t patch, const RgbSum& emitted,
                  std::uint32_t group);
    void addPolygon(const RayCaster& rays, std::uint32_t polygon, bool back, const RgbSum& radiosity,
                    std::uint32_t group);
    void add(EmitterTriangle triangle);
    std::uint32_t build(std::span<std::uint32_t> triangles);
    std::uint32_t join(std::uint32_t left, std::uint32_t right);

    std::vector<EmitterTriangle> triangles_;
    std::vector<EmitterNode> nodes_;
    std::vector<std::uint32_t> nodeGroup_; ///< #nodes
    std::vector<std::uint32_t> groups_;
    std::vector<std::uint32_t> roots_; ///< one per group
};

} // namespace lambert
