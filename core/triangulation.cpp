#include "core/triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>
#include <utility>

namespace lambert {

namespace {

enum class Side : char { Unknown, Outside, Inside };

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceInfo = CGAL::Triangulation_face_base_with_info_2<Side, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel, FaceInfo>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using NoCrossing = CGAL::No_constraint_intersection_requiring_constructions_tag;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, NoCrossing>;

/// The triangles inside: the walk from infinity entered them by an odd number of edges for which `isBorder(face, edge)`.
template <typename IsBorder>
std::vector<std::array<std::uint32_t, 3>> trianglesInside(const Triangulation& triangulation, IsBorder&& isBorder) {
    for (const auto& face : triangulation.all_face_handles()) face->info() = Side::Unknown;
    std::vector<Triangulation::Face_handle> stack{triangulation.infinite_face()};
    stack.back()->info() = Side::Outside;
    while (!stack.empty()) {
        const auto face = stack.back();
        stack.pop_back();
        for (int edge = 0; edge < 3; ++edge) {
            const auto next = face->neighbor(edge);
            if (next->info() != Side::Unknown) continue;
            const bool crossed = isBorder(face, edge);
            next->info() = (face->info() == Side::Inside) != crossed ? Side::Inside : Side::Outside;
            stack.push_back(next);
        }
    }

    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const auto& face : triangulation.finite_face_handles()) {
        if (face->info() != Side::Inside) continue;
        triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    return triangles;
}

} // namespace

std::optional<std::vector<std::array<std::uint32_t, 3>>>
triangulatePolygon(std::span<const glm::dvec2> points, std::size_t borderCount,
                   std::span<const std::array<std::uint32_t, 2>> constraints) {
    Triangulation triangulation;
    std::vector<Triangulation::Vertex_handle> vertices(points.size());
    Triangulation::Face_handle hint;
    for (std::size_t i = 0; i < points.size(); ++i) {
        vertices[i] = triangulation.insert({points[i].x, points[i].y}, hint);
        if (triangulation.number_of_vertices() != i + 1) return std::nullopt; // two points coincide
        vertices[i]->info() = static_cast<std::uint32_t>(i);
        hint = vertices[i]->face();
    }
    if (triangulation.dimension() < 2) return std::nullopt;
    try {
        for (std::size_t i = 0; i < borderCount; ++i)
            triangulation.insert_constraint(vertices[i], vertices[(i + 1) % borderCount]);
        for (const auto& [a, b] : constraints) triangulation.insert_constraint(vertices[a], vertices[b]);
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
        return std::nullopt;
    }

    // Constraints inside do not count: only edges between consecutive border points, or parts of them, do.
    const auto isBorder = [&](const Triangulation::Face_handle& face, int edge) {
        if (!face->is_constrained(edge)) return false;
        const auto a = face->vertex(Triangulation::cw(edge))->info();
        const auto b = face->vertex(Triangulation::ccw(edge))->info();
        if (a >= borderCount || b >= borderCount) return false;
        const std::size_t gap = a > b ? a - b : b - a;
        return gap == 1 || gap == borderCount - 1;
    };
    return trianglesInside(triangulation, isBorder);
}

std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulateLoops(std::span<const glm::dvec2> points,
                                                                          std::span<const std::size_t> loopSizes) {
    Triangulation triangulation;
    std::vector<std::uint32_t> first(points.size()); // of the points at the same place
    std::vector<Triangulation::Vertex_handle> vertices(points.size());
    Triangulation::Face_handle hint;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t before = triangulation.number_of_vertices();
        vertices[i] = triangulation.insert({points[i].x, points[i].y}, hint);
        if (triangulation.number_of_vertices() != before) vertices[i]->info() = static_cast<std::uint32_t>(i);
        first[i] = vertices[i]->info();
        hint = vertices[i]->face();
    }
    if (triangulation.dimension() < 2) return std::nullopt;

    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> isBorder; // edges that were given an odd number of times
    std::size_t begin = 0;
    for (const std::size_t size : loopSizes) {
        for (std::size_t k = 0; k < size; ++k) {
            const auto edge = std::minmax(first[begin + k], first[begin + (k + 1) % size]);
            if (edge.first != edge.second) isBorder[edge] ^= true;
        }
        begin += size;
    }
    try {
        for (const auto& [edge, odd] : isBorder)
            if (odd) triangulation.insert_constraint(vertices[edge.first], vertices[edge.second]);
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
        return std::nullopt;
    }
    auto triangles =
        trianglesInside(triangulation, [](const auto& face, int edge) { return face->is_constrained(edge); });
    if (triangles.empty()) return std::nullopt;
    return triangles;
}

} // namespace lambert
