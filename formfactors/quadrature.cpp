/// Triangles by the conical product: A. H. Stroud, Approximate Calculation of Multiple Integrals, 1971, section 2.4.
#include "formfactors/quadrature.h"

#include <glm/geometric.hpp>

#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

constexpr int kHighestOrder = 8;

/// Nodes and weights on [0, 1].
struct Rule {
    std::array<double, kHighestOrder> node{}, weight{};
};

/// The Jacobi polynomial P_n^(0,b)(x), b of 0 or 1, and its derivative. NIST Handbook of Mathematical Functions, 18.9.
std::array<double, 2> jacobi(int n, double b, double x) {
    double previous = 1.0;
    double value = 0.5 * ((2.0 + b) * x - b);
    for (int k = 2; k <= n; ++k) {
        const double s = 2.0 * k + b;
        const double next =
            ((s - 1.0) * (s * (s - 2.0) * x - b * b) * value - 2.0 * (k - 1.0) * (k - 1.0 + b) * s * previous) /
            (2.0 * k * (k + b) * (s - 2.0));
        previous = value;
        value = next;
    }
    const double s = 2.0 * n + b;
    const double derivative = (n * (-b - s * x) * value + 2.0 * n * (n + b) * previous) / (s * (1.0 - x * x));
    return {value, derivative};
}

/// Gauss's rule for the weight t^b on [0, 1], b of 0 or 1.
Rule gaussRule(int order, int b) {
    Rule rule;
    double mass = 0.0;
    for (int k = 0; k < order; ++k) {
        double x = -std::cos(std::numbers::pi * (k + 0.75 + 0.25 * b) / (order + 0.5 + 0.5 * b));
        for (int step = 0; step < 20; ++step) {
            const auto [value, derivative] = jacobi(order, b, x);
            x -= value / derivative;
        }
        const double derivative = jacobi(order, b, x)[1];
        const auto i = static_cast<std::size_t>(k);
        rule.node[i] = 0.5 * (1.0 + x);
        rule.weight[i] = 1.0 / ((1.0 - x * x) * derivative * derivative);
        mass += rule.weight[i];
    }
    for (double& w : rule.weight) w *= 1.0 / ((1.0 + b) * mass);
    return rule;
}

const Rule& rule(int order, int b) {
    static const auto rules = [] {
        std::array<std::array<Rule, 2>, kHighestOrder + 1> result{};
        for (int n = 1; n <= kHighestOrder; ++n)
            for (int k = 0; k < 2; ++k)
                result[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)] = gaussRule(n, k);
        return result;
    }();
    return rules[static_cast<std::size_t>(order)][static_cast<std::size_t>(b)];
}

} // namespace

void appendGaussPoints(std::span<const glm::dvec3> polygon, int order, std::vector<WeightedPoint>& points) {
    assert(order >= 1 && order <= kHighestOrder && polygon.size() >= 3);
    if (polygon.size() > 4) {
        for (std::size_t k = 1; k + 1 < polygon.size(); k += 2) {
            const bool isQuad = k + 2 < polygon.size();
            const std::array quad{polygon[0], polygon[k], polygon[k + 1], polygon[isQuad ? k + 2 : 0]};
            appendGaussPoints(std::span(quad).first(isQuad ? 4 : 3), order, points);
        }
        return;
    }
    const bool triangle = polygon.size() == 3;
    const Rule& along = rule(order, triangle ? 1 : 0);
    const Rule& across = rule(order, 0);
    const auto n = static_cast<std::size_t>(order);
    for (std::size_t a = 0; a < n; ++a) {
        for (std::size_t b = 0; b < n; ++b) {
            const double u = along.node[a], v = across.node[b];
            glm::dvec3 alongU, alongV, point;
            if (triangle) {
                // From the apex (u = 0) to the opposite side; the rule's weight holds the factor u.
                const glm::dvec3 one = polygon[1] - polygon[0], two = polygon[2] - polygon[0];
                alongU = one;
                alongV = two;
                point = polygon[0] + u * ((1.0 - v) * one + v * two);
            } else {
                alongU = (1.0 - v) * (polygon[1] - polygon[0]) + v * (polygon[2] - polygon[3]);
                alongV = (1.0 - u) * (polygon[3] - polygon[0]) + u * (polygon[2] - polygon[1]);
                point = (1.0 - u) * ((1.0 - v) * polygon[0] + v * polygon[3]) +
                        u * ((1.0 - v) * polygon[1] + v * polygon[2]);
            }
            points.push_back({point, along.weight[a] * across.weight[b] * glm::length(glm::cross(alongU, alongV))});
        }
    }
}

} // namespace lambert
