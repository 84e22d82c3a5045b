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

/// Every edge at a point costs a turn around all edges there, so that the time grows with the square of this.
constexpr std::size_t kMostReturns = 1000;

/// How often the border goes around a face, counter-clockwise; and how much that changes from here across each edge.
struct Winding {
    int number = 0;
    bool known = false;
    std::array<int, 3> change{};
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceInfo = CGAL::Triangulation_face_base_with_info_2<Winding, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel, FaceInfo>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using NoCrossing = CGAL::No_constraint_intersection_requiring_constructions_tag;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, NoCrossing>;
using Vertex = Triangulation::Vertex_handle;
using Face = Triangulation::Face_handle;

/// The vertices of `points`, or nothing if two coincide that may not.
std::optional<std::vector<Vertex>> insertPoints(Triangulation& triangulation, std::span<const glm::dvec2> points,
                                                std::size_t borderCount) {
    std::vector<Vertex> vertices(points.size());
    std::vector<std::size_t> returns(borderCount, 0);
    Face hint;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t before = triangulation.number_of_vertices();
        vertices[i] = triangulation.insert({points[i].x, points[i].y}, hint);
        if (triangulation.number_of_vertices() != before) {
            vertices[i]->info() = static_cast<std::uint32_t>(i);
            hint = vertices[i]->face(); // not that of an older one, which may be a hub's and lie on its far side
        } else if (i >= borderCount || ++returns[vertices[i]->info()] > kMostReturns) {
            return std::nullopt;
        }
    }
    for (std::size_t i = 0; i < borderCount; ++i)
        if (vertices[i] == vertices[(i + 1) % borderCount]) return std::nullopt;
    return vertices;
}

/// The part of the constraint from `from` to `to` that begins at `from`: the face on its left, and the edge there.
Triangulation::Edge firstPart(const Triangulation& triangulation, Vertex from, Vertex to) {
    auto face = triangulation.incident_faces(from);
    while (true) {
        const int index = face->index(from);
        const int edge = Triangulation::cw(index); // from `from` to the next corner
        const Vertex next = face->vertex(Triangulation::ccw(index));
        const bool along =
            face->is_constrained(edge) && !triangulation.is_infinite(next) &&
            (next == to || CGAL::are_strictly_ordered_along_line(from->point(), next->point(), to->point()));
        if (along) return {face, edge};
        ++face;
    }
}

/// Counts the border edge from `from` to `to`, which may pass through other vertices.
void countBorderEdge(const Triangulation& triangulation, Vertex from, Vertex to) {
    while (from != to) {
        const auto [left, edge] = firstPart(triangulation, from, to);
        const Face right = left->neighbor(edge);
        const int mirrored = triangulation.mirror_index(left, edge);
        --left->info().change[static_cast<std::size_t>(edge)];
        ++right->info().change[static_cast<std::size_t>(mirrored)];
        from = left->vertex(Triangulation::cw(edge));
    }
}

/// Gives every face its winding number, from outside inwards.
void spreadWinding(Triangulation& triangulation) {
    std::vector<Face> stack{triangulation.infinite_face()};
    stack.back()->info().known = true;
    while (!stack.empty()) {
        const Face face = stack.back();
        stack.pop_back();
        for (int edge = 0; edge < 3; ++edge) {
            Winding& next = face->neighbor(edge)->info();
            if (next.known) continue;
            next.number = face->info().number + face->info().change[static_cast<std::size_t>(edge)];
            next.known = true;
            stack.push_back(face->neighbor(edge));
        }
    }
}

/// Appends a face as indices of points.
void append(Face face, std::vector<std::array<std::uint32_t, 3>>& triangles) {
    triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
}

} // namespace

std::optional<std::vector<std::array<std::uint32_t, 3>>>
triangulatePolygon(std::span<const glm::dvec2> points, std::size_t borderCount,
                   std::span<const std::array<std::uint32_t, 2>> constraints) {
    Triangulation triangulation;
    const auto vertices = insertPoints(triangulation, points, borderCount);
    if (!vertices || triangulation.dimension() < 2) return std::nullopt;
    const auto next = [&](std::size_t i) { return (*vertices)[(i + 1) % borderCount]; };
    try {
        for (std::size_t i = 0; i < borderCount; ++i) triangulation.insert_constraint((*vertices)[i], next(i));
        for (const auto& [a, b] : constraints) triangulation.insert_constraint((*vertices)[a], (*vertices)[b]);
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
        return std::nullopt;
    }
    for (const Face face : triangulation.all_face_handles()) face->info() = {};
    for (std::size_t i = 0; i < borderCount; ++i) countBorderEdge(triangulation, (*vertices)[i], next(i));
    spreadWinding(triangulation);

    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const Face face : triangulation.finite_face_handles()) {
        const int winding = face->info().number;
        if (winding != 0 && winding != 1) return std::nullopt;
        if (winding == 1) append(face, triangles);
    }
    return triangles;
}

std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulateLoops(std::span<const glm::dvec2> points,
                                                                          std::span<const std::size_t> loopSizes) {
    Triangulation triangulation;
    std::vector<std::uint32_t> first(points.size()); // of the points at the same place
    std::vector<Vertex> vertices(points.size());
    Face hint;
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
    for (const Face face : triangulation.all_face_handles())
        for (int edge = 0; edge < 3; ++edge)
            face->info().change[static_cast<std::size_t>(edge)] = face->is_constrained(edge) ? 1 : 0;
    spreadWinding(triangulation); // counts edges crossed: both ways are one more
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const Face face : triangulation.finite_face_handles())
        if (face->info().number % 2 != 0) append(face, triangles);
    if (triangles.empty()) return std::nullopt;
    return triangles;
}

std::optional<std::vector<std::array<std::uint32_t, 3>>>
triangulateLines(std::span<const glm::dvec2> points, std::span<const std::array<std::uint32_t, 2>> lines) {
    Triangulation triangulation;
    const auto vertices = insertPoints(triangulation, points, 0);
    if (!vertices || triangulation.dimension() < 2) return std::nullopt;
    try {
        for (const auto& [a, b] : lines) triangulation.insert_constraint((*vertices)[a], (*vertices)[b]);
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
        return std::nullopt;
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangles.reserve(triangulation.number_of_faces());
    for (const Face face : triangulation.finite_face_handles()) append(face, triangles);
    return triangles;
}

} // namespace lambert
