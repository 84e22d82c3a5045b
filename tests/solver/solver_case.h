#pragma once

#include "core/parallel.h"
#include "core/random.h"
#include "formfactors/form_factor_method.h"
#include "solver/form_factor_rows.h"
#include "solver/problem.h"
#include "solver/solver.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace lambert {

/// Patches that exist for their material only.
struct BarePatches {
    std::vector<float> area;
    PatchOptics optics;

    operator PatchViews() const { return {area, optics}; }
};

/// Of area 1.
inline BarePatches patchesWith(std::span<const float> reflectance, std::span<const float> emitted) {
    BarePatches patches;
    patches.area.assign(reflectance.size(), 1.0F);
    for (const float rho : reflectance) patches.optics.reflectance.emplace_back(rho);
    for (const float b : emitted) patches.optics.emittedRadiosity.emplace_back(b);
    return patches;
}

inline FormFactorMatrix dense(std::size_t count, const std::function<double(std::size_t, std::size_t)>& factor) {
    FormFactorMatrix matrix(count, MatrixStorage::Double);
    for (std::size_t i = 0; i < count; ++i) {
        FormFactorRow row;
        for (std::size_t j = 0; j < count; ++j)
            if (const double f = factor(i, j); f > 0.0) row.entries.push_back({static_cast<std::uint32_t>(j), f});
        matrix.setRow(i, row);
    }
    return matrix;
}

/// Two patches that see nothing but each other.
inline FormFactorMatrix plates() {
    return dense(2, [](std::size_t i, std::size_t j) { return i == j ? 0.0 : 1.0; });
}

/// Six patches of a unit cube: faces 2k and 2k + 1 oppose each other.
inline FormFactorMatrix cubeMatrix() {
    return dense(6, [](std::size_t i, std::size_t j) {
        if (i == j) return 0.0;
        return i / 2 == j / 2 ? 0.1998248957 : 0.2000437761;
    });
}

/// A mesh keeps reflectances as floats, off by up to 3e-8 of themselves; what is solved from them is off by a little more.
inline constexpr double kFloatReflectance = 5e-8;

/// Patches and values of data/reference/analytic.json, which has nine digits.
struct ReferenceCase {
    ReferenceCase(const std::string& scene, const std::string& key) {
        std::ifstream file(LAMBERT_DATA "/reference/analytic.json");
        const nlohmann::json json = nlohmann::json::parse(file).at(scene);
        patches = patchesWith(json.at("rho").get<std::vector<float>>(), json.at("E").get<std::vector<float>>());
        values = json.at(key).get<std::vector<double>>();
    }
    BarePatches patches;
    std::vector<double> values;
};

inline double uniform(std::uint32_t i, std::uint32_t j, std::uint64_t seed) {
    return static_cast<double>(uniformFloat(philox({i, j, 0, 0}, seed)[0]));
}

/// A reciprocal random matrix, a fifth full, with areas from 0.5 to 2, reflectances from 0 to 0.95, and every tenth patch
/// emitting; rows sum to 1 with what meets backs and leaves. `closed`: instead of that, patches see themselves.
struct RandomMatrix {
    RandomMatrix(std::uint32_t count, std::uint64_t seed, bool closed = false) : matrix(count, MatrixStorage::Double) {
        std::vector<float> nothing(count, 0.0F);
        patches = patchesWith(nothing, nothing);
        const auto random = [&](std::uint32_t i, std::uint32_t j) { return uniform(i, j, seed); };
        std::vector<FormFactorRow> rows(count);
        double largest = 0.0;
        for (std::uint32_t i = 0; i < count; ++i) {
            patches.area[i] = static_cast<float>(0.5 + 1.5 * random(i, count));
            for (std::uint32_t c = 0; c < 3; ++c) {
                patches.optics.reflectance[i][static_cast<int>(c)] =
                    static_cast<float>(0.95 * random(i, count + 1 + c));
                if (i % 10 == 0)
                    patches.optics.emittedRadiosity[i][static_cast<int>(c)] =
                        static_cast<float>(10.0 * random(i, count + 4 + c));
            }
            for (std::uint32_t j = 0; j < count; ++j) {
                const double exchange = random(std::min(i, j), std::max(i, j));
                if (i == j || exchange > 0.2) continue;
                rows[i].entries.push_back({j, exchange / static_cast<double>(patches.area[i])});
            }
            largest = std::max(largest, rows[i].sum());
        }
        for (std::uint32_t i = 0; i < count; ++i) {
            for (FormFactor& factor : rows[i].entries) factor.value /= largest;
            const double rest = 1.0 - rows[i].sum();
            if (closed) {
                const auto at = std::ranges::lower_bound(rows[i].entries, i, {}, &FormFactor::patch);
                rows[i].entries.insert(at, {i, rest});
            } else {
                rows[i].back = rows[i].out = 0.5 * rest;
            }
            matrix.setRow(i, rows[i]);
        }
    }
    BarePatches patches;
    FormFactorMatrix matrix;
};

/// The matrix as it is found with a few lines from each patch.
inline FormFactorMatrix fromFewLines(const FormFactorMatrix& matrix, std::uint32_t lines, std::uint64_t seed) {
    FormFactorMatrix result(matrix.size(), MatrixStorage::Double);
    RowAccumulator accumulator(matrix.size());
    FormFactorRow row;
    for (std::uint32_t i = 0; i < matrix.size(); ++i) {
        const FormFactorRow exact = matrix.row(i);
        for (std::uint32_t k = 0; k < lines; ++k) {
            double left = uniform(i, k, seed);
            std::uint32_t target = accumulator.out();
            for (const FormFactor& factor : exact.entries)
                if ((left -= factor.value) < 0.0) {
                    target = factor.patch;
                    break;
                }
            accumulator.add(target, 1.0 / lines);
        }
        accumulator.take(row);
        result.setRow(i, row);
    }
    return result;
}

/// Rows of a matrix as if they were computed.
class MatrixAsMethod : public FormFactorMethod {
public:
    explicit MatrixAsMethod(const FormFactorMatrix& matrix) : matrix_(matrix) {}
    void row(std::uint32_t patch, RowAccumulator& accumulator) const override {
        matrix_.visit(patch, [&](std::uint32_t j, double factor) { accumulator.add(j, factor); });
        accumulator.add(accumulator.back(), matrix_.back(patch));
        accumulator.add(accumulator.out(), matrix_.out(patch));
    }
    std::size_t patchCount() const override { return matrix_.size(); }
    std::uint64_t raysPerRow() const override { return 0; }

private:
    const FormFactorMatrix& matrix_;
};

/// Every solver that takes form factors, and its name as part of a test's.
inline auto deterministicSolvers() {
    return testing::Values(SolverMethod::Jacobi, SolverMethod::GaussSeidel, SolverMethod::Southwell,
                           SolverMethod::ConjugateGradient);
}
inline std::string solverTestName(const testing::TestParamInfo<SolverMethod>& tested) {
    std::string name(nameOf(tested.param));
    std::erase(name, '-');
    return name;
}

/// Back to one thread per processor at the end.
struct ThreadCountGuard {
    ~ThreadCountGuard() { setThreadCount(0); }
};

} // namespace lambert
