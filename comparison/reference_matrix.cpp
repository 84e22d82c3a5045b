#include "comparison/reference_matrix.h"

#include "comparison/form_factor_errors.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "formfactors/closed_form.h"
#include "formfactors/matrix_file.h"
#include "formfactors/matrix_source.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

constexpr double kConvexTolerance = 1e-5; ///< of the scene's size

/// Of the closed form where nothing is exact, in partly hidden factors: a tenth of the best that is compared.
constexpr double kReferenceError = 1e-4;
constexpr double kReferenceLines = 131072;   // per patch, twice
constexpr std::size_t kMostIntegrated = 100; // polygons

std::vector<std::vector<glm::dvec3>> polygons(const PatchMesh& mesh) {
    std::vector<std::vector<glm::dvec3>> result(mesh.size());
    for (std::size_t i = 0; i < mesh.size(); ++i)
        for (int k = 0; k < mesh.cornerCount(i); ++k) result[i].emplace_back(mesh.position(i, k));
    return result;
}

FormFactorMatrix mean(const FormFactorMatrix& a, const FormFactorMatrix& b) {
    FormFactorMatrix result(a.size(), MatrixStorage::Double);
    parallelFor(a.size(), 16, [&](std::size_t begin, std::size_t end, int) {
        RowAccumulator sum(a.size());
        FormFactorRow row;
        for (std::size_t i = begin; i < end; ++i) {
            for (const FormFactorMatrix* matrix : {&a, &b}) {
                matrix->visit(i, [&](std::uint32_t j, double factor) { sum.add(j, 0.5 * factor); });
                sum.add(sum.back(), 0.5 * matrix->back(i));
                sum.add(sum.out(), 0.5 * matrix->out(i));
            }
            sum.take(row);
            result.setRow(i, row);
        }
    });
    return result;
}

ReferenceMatrix byMethod(const ComparedMethod& method, double effort, const MeshedScene& scene, std::uint64_t seed,
                         double threshold, Progress& progress) {
    if (!method.random)
        return {fmt::format("{}, {}", method.name, effortText(method, effort)),
                method.compute(scene, effort, seed, MatrixStorage::Double, progress).matrix, effort};
    const auto half = [&](std::uint32_t number) {
        return method
            .compute(scene, effort, randomKey({number, 0, 0, 0x52454652}, seed), MatrixStorage::Double, progress)
            .matrix;
    };
    const FormFactorMatrix first = half(0);
    const FormFactorMatrix second = half(1);
    ReferenceMatrix result{
        fmt::format("{}, {}, mean of two", method.name, effortText(method, effort)), mean(first, second), {}};
    // Of two independent halves with errors e and f the mean errs by (e + f) / 2 and is (e − f) / 2 away from them: as much.
    const FormFactorErrors errors = formFactorErrors(first, result.matrix, scene.mesh.area, threshold);
    result.ownError = errors.relativeRms;
    return result;
}

} // namespace

ReferenceChoice parseReference(const std::string& text) {
    if (text == "auto") return {};
    if (text == "exact") return {ReferenceChoice::Kind::Exact, nullptr, 0.0, {}};
    if (matrixFormatOf(text)) return {ReferenceChoice::Kind::File, nullptr, 0.0, text};
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos)
        throw UsageError(fmt::format("--reference: found \"{}\", allowed are auto, exact, METHOD:EFFORT such as "
                                     "local-lines:262144, or a matrix file (.mtx, .npy, .csv, .txt)",
                                     text));
    const ComparedMethod& method = comparedMethod(text.substr(0, colon));
    return {ReferenceChoice::Kind::Method, &method, parseEffort(method, text.substr(colon + 1)), {}};
}

bool isConvex(const Scene& scene) {
    const float tolerance = static_cast<float>(kConvexTolerance) * boundsOf(scene).diagonal();
    return std::all_of(scene.polygons.begin(), scene.polygons.end(), [&](const Polygon& polygon) {
        const Material& material = scene.materials[polygon.material];
        if (material.occluder || material.hasHoles() || polygon.backMaterial != kNone) return false;
        const glm::vec3 normal = glm::vec3(glm::normalize(glm::dvec3(areaVector(scene, polygon))));
        const float plane = glm::dot(normal, corner(scene, polygon, 0)) - tolerance;
        return std::all_of(scene.polygons.begin(), scene.polygons.end(), [&](const Polygon& other) {
            for (int k = 0; k < other.size(); ++k)
                if (glm::dot(normal, corner(scene, other, k)) < plane) return false;
            return true;
        });
    });
}

FormFactorMatrix unoccludedMatrix(const PatchMesh& mesh, Progress& progress) {
    const std::vector<std::vector<glm::dvec3>> patches = polygons(mesh);
    FormFactorMatrix matrix(mesh.size(), MatrixStorage::Double);
    progress.begin("closed form", mesh.size());
    parallelFor(mesh.size(), 1, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t i = begin; i < end; ++i) {
            FormFactorRow row;
            double sum = 0.0;
            for (std::size_t j = 0; j < patches.size(); ++j) {
                if (j == i) continue;
                // The one order for both directions, so that the matrix is reciprocal.
                const double exchange = exchangeArea(patches[std::min(i, j)], patches[std::max(i, j)]);
                const double factor = exchange / static_cast<double>(mesh.area[i]);
                if (factor > 0.0) row.entries.push_back({static_cast<std::uint32_t>(j), factor});
                sum += std::max(factor, 0.0);
            }
            row.out = std::max(0.0, 1.0 - sum);
            matrix.setRow(i, row);
        }
        progress.advance(end - begin);
    });
    progress.end();
    return matrix;
}

ReferenceMatrix makeReference(const ReferenceChoice& choice, const MeshedScene& scene, std::uint64_t seed,
                              double threshold, Progress& progress) {
    using Kind = ReferenceChoice::Kind;
    if (choice.kind == Kind::File)
        return {choice.file.filename().string(), readMatrixOf(scene.mesh, choice.file, MatrixStorage::Double), {}};
    if (choice.kind == Kind::Method) return byMethod(*choice.method, choice.effort, scene, seed, threshold, progress);
    if (isConvex(*scene.scene))
        return {"exact (closed form of every pair)", unoccludedMatrix(scene.mesh, progress), 0.0};
    if (choice.kind == Kind::Exact)
        throw UsageError("--reference exact: the scene is not convex, so that some of its surfaces may hide others");
    // Behind much furniture integration takes longer than counting does.
    if (scene.scene->polygons.size() > kMostIntegrated)
        return byMethod(comparedMethod("local-lines"), kReferenceLines, scene, seed, threshold, progress);
    return byMethod(comparedMethod("closed-form"), kReferenceError, scene, seed, threshold, progress);
}

} // namespace lambert
