#include "exact_case.h"

#include "core/error.h"
#include "core/parallel.h"
#include "core/state_checkpoint.h"
#include "formfactors/global_lines.h"
#include "formfactors/repair.h"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

namespace lambert {
namespace {

constexpr std::array kSamplers{Sampler::Random, Sampler::Stratified, Sampler::Halton, Sampler::Sobol};
constexpr std::array kSets{LineSet::Chords, LineSet::Bundles};

std::string nameOf(const GlobalLineOptions& options) {
    return std::string(options.set == LineSet::Chords ? "chords" : "bundles") + ", sampler " +
           std::to_string(static_cast<int>(options.sampler)) + ", seed " + std::to_string(options.seed);
}

/// A mesh with what global lines need.
struct LinesCase {
    explicit LinesCase(const Scene& source, std::size_t patches = 0) : scene(prepareScene(source)), caster(scene) {
        MeshOptions options;
        options.patches = patches;
        Progress progress;
        mesh = buildPatchMesh(scene, options, progress);
    }
    GlobalLineCounts counts(const GlobalLineOptions& options) const {
        const GlobalLines lines(mesh, caster, options);
        GlobalLineCounts result(mesh.size());
        Progress progress;
        lines.trace(result, progress);
        return result;
    }
    FormFactorMatrix matrix(const GlobalLineOptions& options, MatrixStorage storage = MatrixStorage::Double) const {
        Progress progress;
        return counts(options).matrix(storage, progress);
    }
    Scene scene;
    LineCaster caster;
    PatchMesh mesh;
};

FormFactorMatrix matrixOf(const GlobalLineCounts& counts, MatrixStorage storage = MatrixStorage::Double) {
    Progress progress;
    return counts.matrix(storage, progress);
}

/// 2πR²: the measure of all lines through the sphere, per area of a patch that is crossed.
double lineMeasure(const LinesCase& c, const GlobalLineOptions& options) {
    const double radius = static_cast<double>(IsotropicLines(boundsOf(c.scene), options).radius());
    return 2.0 * std::numbers::pi * radius * radius;
}

/// Exchange areas X_ij ≈ N_ij 2πR² / N, and on the diagonal the areas N_i 2πR² / N.
std::vector<double> exchangeAreas(const LinesCase& c, const GlobalLineOptions& options) {
    const GlobalLineCounts counts = c.counts(options);
    const FormFactorMatrix matrix = matrixOf(counts);
    const std::vector<std::uint32_t> crossings = counts.crossings();
    const double unit = lineMeasure(c, options) / options.lines;
    const std::size_t n = crossings.size();
    std::vector<double> result(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        result[n * i + i] = unit * crossings[i];
        matrix.visit(i, [&](std::uint32_t j, double f) { result[n * i + j] = unit * f * crossings[i]; });
    }
    return result;
}

/// Mean and its variance, from independent seeds.
struct SeedStatistics {
    double sum = 0.0, squares = 0.0;
    int seeds = 0;
    void add(double value) {
        sum += value;
        squares += value * value;
        ++seeds;
    }
    double mean() const { return sum / seeds; }
    double standardError() const { return std::sqrt((squares / seeds - mean() * mean()) / (seeds - 1)); }
};

// z-test of the mean over 64 seeds, with the seeds' own standard error, of every exchange area and of every patch's area (which
// is the crossing probability A / 2πR²). Two scenes × 2 sets × 4 samplers × (15 pairs + 6 patches) = 336 tests: to fail by
// chance once in 1000 (Šidák), each must fail once in 336,000: Student's t with 63 degrees of freedom, 5.1 standard errors.
TEST(GlobalLines, AreUnbiasedForEveryPair) {
    for (const glm::vec3& size : {kCube6, kRoom432}) {
        const ExactCase exact(closedBox(size));
        const LinesCase c(closedBox(size));
        for (const LineSet set : kSets) {
            for (const Sampler sampler : kSamplers) {
                std::vector<SeedStatistics> statistics(36);
                GlobalLineOptions options{.lines = 2048, .set = set, .linesPerBundle = 64, .sampler = sampler};
                for (options.seed = 1; options.seed <= 64; ++options.seed) {
                    const std::vector<double> exchange = exchangeAreas(c, options);
                    for (std::size_t k = 0; k < 36; ++k) statistics[k].add(exchange[k]);
                }
                for (std::size_t i = 0; i < 6; ++i) {
                    for (std::size_t j = i; j < 6; ++j) {
                        const auto area = static_cast<double>(c.mesh.area[i]);
                        const double expected = i == j ? area : area * exact.factor[i][j];
                        const SeedStatistics& s = statistics[6 * i + j];
                        EXPECT_LT(std::abs(s.mean() - expected), 5.1 * s.standardError())
                            << nameOf(options) << " pair " << i << " " << j << " mean " << s.mean() << " exact "
                            << expected;
                    }
                }
            }
        }
    }
}

// The same of the rows N_ij / N_i, for independent lines: 2 × 30 tests, 4.7 standard errors.
TEST(GlobalLines, RowsOfIndependentLinesAreUnbiased) {
    for (const glm::vec3& size : {kCube6, kRoom432}) {
        const ExactCase exact(closedBox(size));
        const LinesCase c(closedBox(size));
        std::vector<SeedStatistics> statistics(36);
        for (std::uint64_t seed = 1; seed <= 64; ++seed) {
            const FormFactorMatrix matrix = c.matrix({.lines = 2048, .sampler = Sampler::Random, .seed = seed});
            for (std::uint32_t i = 0; i < 6; ++i)
                for (std::uint32_t j = 0; j < 6; ++j) statistics[6 * i + j].add(entry(matrix.row(i), j));
        }
        for (std::size_t i = 0; i < 6; ++i) {
            for (std::size_t j = 0; j < 6; ++j) {
                if (i == j) continue;
                const SeedStatistics& s = statistics[6 * i + j];
                EXPECT_LT(std::abs(s.mean() - exact.factor[i][j]), 4.7 * s.standardError())
                    << "pair " << i << " " << j << ", seeds 1 to 64";
            }
        }
    }
}

/// Error exponent of the exchange areas: RMS over pairs and 16 seeds at numbers of lines that grow fourfold.
double errorSlope(LineSet set, Sampler sampler) {
    const ExactCase exact(closedBox(kRoom432));
    const LinesCase c(closedBox(kRoom432));
    std::vector<double> lines, error;
    for (const std::uint32_t perBundle : {32U, 64U, 128U, 256U}) {
        GlobalLineOptions options{
            .lines = perBundle * perBundle, .set = set, .linesPerBundle = perBundle, .sampler = sampler};
        double squares = 0.0;
        for (options.seed = 1; options.seed <= 16; ++options.seed) {
            const std::vector<double> exchange = exchangeAreas(c, options);
            for (std::size_t i = 0; i < 6; ++i)
                for (std::size_t j = i + 1; j < 6; ++j)
                    squares +=
                        std::pow(exchange[6 * i + j] - static_cast<double>(c.mesh.area[i]) * exact.factor[i][j], 2.0);
        }
        lines.push_back(options.lines);
        error.push_back(std::sqrt(squares));
    }
    return logarithmicSlope(lines, error);
}

// Independent chords: −1/2. 15 pairs × 16 seeds tell an RMS to 5 %, a slope over a factor of 64 to 0.02. Points spread in all four
// dimensions gain 1 / (2 · 4) at least, with edges for discontinuities: −5/8. Bundles of L lines in L directions: independent directions
// −1/4, with spread ones both the directions and the lines of each gain.
TEST(GlobalLines, ErrorFallsAtItsRate) {
    EXPECT_NEAR(errorSlope(LineSet::Chords, Sampler::Random), -0.5, 0.08);
    EXPECT_NEAR(errorSlope(LineSet::Chords, Sampler::Stratified), -0.5, 0.08);
    EXPECT_LT(errorSlope(LineSet::Chords, Sampler::Halton), -0.6);
    EXPECT_LT(errorSlope(LineSet::Chords, Sampler::Sobol), -0.6);
    EXPECT_NEAR(errorSlope(LineSet::Bundles, Sampler::Random), -0.25, 0.08);
    EXPECT_LT(errorSlope(LineSet::Bundles, Sampler::Sobol), -0.5);
}

TEST(GlobalLines, RowsCloseToTheLastLine) {
    Scene open = roomWithBoxScene();
    open.polygons.erase(open.polygons.begin() + 1); // a wall is gone: lines leave, and meet backs from outside
    const LinesCase c(open, 300);
    for (const LineSet set : kSets) {
        const GlobalLineCounts counts = c.counts({.lines = 100'000, .set = set});
        const std::vector<std::uint32_t> crossings = counts.crossings();
        const FormFactorMatrix matrix = matrixOf(counts);
        double back = 0.0, out = 0.0;
        for (std::size_t i = 0; i < c.mesh.size(); ++i) {
            double sum = matrix.back(i) * crossings[i] + matrix.out(i) * crossings[i];
            matrix.visit(i, [&](std::uint32_t j, double f) {
                sum += f * crossings[i];
                EXPECT_NE(j, i);
            });
            EXPECT_NEAR(sum, crossings[i], 1e-9 * crossings[i]); // whole numbers, but for the divisions by N_i
            back += matrix.back(i);
            out += matrix.out(i);
        }
        EXPECT_GT(out, 1.0);
        EXPECT_GT(back, 0.1); // the box has no bottom: its walls' backs are not seen, but the room's are from its front
    }
}

TEST(GlobalLines, SeePatchesOnBothSidesOfASheet) {
    Scene scene = closedBox(kRoom432);
    addQuad(scene, {{{1, 0, 0}, {1, 3, 0}, {1, 3, 2.5}, {1, 0, 2.5}}}, 6);
    scene.materials.push_back(greyMaterial("sheet", 0.5F));
    scene.materials[6].twoSided = true;
    const ExactCase exact(scene);
    const LinesCase c(scene);
    ASSERT_EQ(c.mesh.size(), 8U);
    // Both sides see all of what lies before them. z-tests as above: 2 × 2 × 8, five standard errors, once in 10^4.
    for (const LineSet set : kSets) {
        std::array<SeedStatistics, 16> statistics;
        GlobalLineOptions options{.lines = 4096, .set = set, .linesPerBundle = 64};
        for (options.seed = 1; options.seed <= 64; ++options.seed) {
            const std::vector<double> exchange = exchangeAreas(c, options);
            for (std::size_t k = 0; k < 16; ++k) statistics[k].add(exchange[48 + k]);
            EXPECT_EQ(exchange[48 + 6], exchange[56 + 7]);
        }
        for (std::size_t side = 6; side < 8; ++side)
            for (std::size_t j = 0; j < 8; ++j) {
                const auto area = static_cast<double>(c.mesh.area[side]);
                const double expected = area * (side == j ? 1.0 : exact.factor[side][j]);
                const SeedStatistics& s = statistics[8 * (side - 6) + j];
                EXPECT_LE(std::abs(s.mean() - expected), 5.0 * s.standardError() + 1e-12)
                    << nameOf(options) << " " << side << " " << j;
            }
        const FormFactorMatrix matrix = c.matrix(options);
        for (const std::size_t side : {6U, 7U}) EXPECT_EQ(matrix.back(side) + matrix.out(side), 0.0);
    }
}

TEST(GlobalLines, MeetOccludersOnTheirBack) {
    Scene scene = closedBox(kCube6);
    addQuad(scene, {{{0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5}}}, 6);
    scene.materials.push_back(greyMaterial("shutter", 0.0F));
    scene.materials[6].occluder = true;
    const LinesCase c(scene);
    ASSERT_EQ(c.mesh.size(), 6U);
    const FormFactorMatrix matrix = c.matrix({.lines = 200'000});
    for (const std::uint32_t i : {4U, 5U}) { // floor and ceiling, parted by it
        EXPECT_EQ(entry(matrix.row(i), 9 - i), 0.0);
        // Squares at half their size: 0.4153 (Howell C-11). About 40,000 lines: a standard deviation of 0.0025, and less by Sobol's.
        EXPECT_NEAR(matrix.back(i), 0.41525, 0.01);
    }
}

TEST(GlobalLines, AScaleOfAPowerOfTwoChangesNoDigit) {
    const FormFactorMatrix metres = LinesCase(closedBox(kRoom432)).matrix({.lines = 10'000});
    for (const int exponent : {-34, -20, 40}) {
        const FormFactorMatrix scaled =
            LinesCase(closedBox(std::ldexp(1.0F, exponent) * kRoom432)).matrix({.lines = 10'000});
        for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(scaled.row(i), metres.row(i)) << exponent;
    }
}

TEST(GlobalLines, DoNotDependOnThreads) {
    const LinesCase c(roomWithBoxScene(), 500);
    for (const LineSet set : kSets) {
        const GlobalLineOptions options{.lines = 150'001, .set = set};
        setThreadCount(1);
        const GlobalLineCounts one = c.counts(options);
        const FormFactorMatrix matrix = matrixOf(one, MatrixStorage::Float);
        for (const int threads : {2, 5}) {
            setThreadCount(threads);
            const GlobalLineCounts several = c.counts(options);
            EXPECT_EQ(one, several);
            const FormFactorMatrix again = matrixOf(several, MatrixStorage::Float);
            for (std::size_t i = 0; i < matrix.size(); ++i) EXPECT_EQ(matrix.row(i), again.row(i));
        }
        setThreadCount(0);
        EXPECT_EQ(one.lines(), options.lines);
    }
}

TEST(GlobalLines, LeaveRowsEmptyThatNoLineCrosses) {
    const LinesCase c(roomWithBoxScene(), 2000);
    const GlobalLineCounts counts = c.counts({.lines = 1000});
    const std::vector<std::uint32_t> crossings = counts.crossings();
    FormFactorMatrix matrix = matrixOf(counts);
    std::size_t empty = 0;
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        EXPECT_EQ(matrix.isEmpty(i), crossings[i] == 0);
        empty += matrix.isEmpty(i) ? 1 : 0;
        EXPECT_NEAR(matrix.row(i).sum(), matrix.isEmpty(i) ? 0.0 : 1.0, 1e-12);
    }
    EXPECT_GT(empty, 100U);
    EXPECT_LT(empty, matrix.size());
    const RepairReport report = repair(matrix, c.mesh.area, counts.repairWeights(c.mesh.area), {.maxIterations = 10});
    for (const std::size_t i : report.failed) EXPECT_GT(crossings[i], 0U);
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        EXPECT_EQ(matrix.isEmpty(i), crossings[i] == 0);
        EXPECT_TRUE(std::isfinite(matrix.row(i).sum()));
    }
}

TEST(GlobalLines, BecomeReciprocalAndClosedByRepair) {
    const LinesCase c(roomWithBoxScene(), 200);
    const GlobalLineCounts counts = c.counts({.lines = 500'000});
    FormFactorMatrix matrix = matrixOf(counts);
    const RepairReport report = repair(matrix, c.mesh.area, counts.repairWeights(c.mesh.area));
    EXPECT_TRUE(report.failed.empty());
    EXPECT_LT(report.remainingError, 1e-6);
    for (std::uint32_t i = 0; i < matrix.size(); ++i)
        matrix.visit(i, [&](std::uint32_t j, double f) {
            const double ours = static_cast<double>(c.mesh.area[i]) * f;
            EXPECT_NEAR(static_cast<double>(c.mesh.area[j]) * entry(matrix.row(j), i), ours, 1e-9 * ours);
        });
}

TEST(GlobalLines, CompactStorageKeepsThemExactly) {
    const LinesCase c(roomWithBoxScene(), 200);
    const GlobalLineCounts counts = c.counts({.lines = 50'000});
    const FormFactorMatrix plain = matrixOf(counts);
    const FormFactorMatrix compact = matrixOf(counts, MatrixStorage::Compact);
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const FormFactorRow a = plain.row(i);
        const FormFactorRow b = compact.row(i);
        ASSERT_EQ(a.entries.size(), b.entries.size());
        for (std::size_t k = 0; k < a.entries.size(); ++k) {
            EXPECT_EQ(a.entries[k].patch, b.entries[k].patch);
            EXPECT_NEAR(a.entries[k].value, b.entries[k].value, 1e-15);
        }
    }
}

/// Cancels when a number of lines is done.
class Interrupter : public Progress {
public:
    explicit Interrupter(std::uint64_t lines) : lines_(lines) {}

private:
    void onAdvance(std::uint64_t done, std::uint64_t) override {
        if (done >= lines_) cancel();
    }
    std::uint64_t lines_;
};

TEST(GlobalLines, GoOnWithTheSameBitsAfterAnInterruption) {
    const LinesCase c(roomWithBoxScene(), 500);
    for (const LineSet set : kSets) {
        const GlobalLineOptions options{.lines = 2'500'000, .set = set};
        const GlobalLineCounts whole = c.counts(options);
        const GlobalLines lines(c.mesh, c.caster, options);
        GlobalLineCounts counts(c.mesh.size());
        Interrupter interrupter(1'800'000);
        EXPECT_THROW(lines.trace(counts, interrupter), Cancelled);
        EXPECT_GT(counts.lines(), 0U); // whole batches
        EXPECT_LT(counts.lines(), 2'500'000U);

        std::string bytes;
        StateWriter writer(bytes);
        counts.keep(writer);
        GlobalLineCounts loaded(0);
        StateReader reader(bytes, "counts");
        loaded.keep(reader);
        EXPECT_EQ(loaded, counts);
        Progress progress;
        lines.trace(loaded, progress);
        EXPECT_EQ(loaded, whole);
    }
}

TEST(GlobalLineCounts, OfOtherLinesAreRefused) {
    const LinesCase c(closedBox(kCube6), 24);
    GlobalLineCounts tooMany = c.counts({.lines = 5000});
    Progress progress;
    EXPECT_THROW(GlobalLines(c.mesh, c.caster, {.lines = 4000}).trace(tooMany, progress), UsageError);
    GlobalLineCounts ofFewerPatches(23);
    EXPECT_THROW(GlobalLines(c.mesh, c.caster, {.lines = 4000}).trace(ofFewerPatches, progress), UsageError);
}

TEST(GlobalLines, RefuseOptionsOutOfRange) {
    const LinesCase c(closedBox(kCube6));
    EXPECT_THROW(GlobalLines(c.mesh, c.caster, {.lines = 0}), UsageError);
    EXPECT_THROW(GlobalLines(c.mesh, c.caster, {.set = LineSet::Bundles, .linesPerBundle = 0}), UsageError);
    EXPECT_THROW(GlobalLines(c.mesh, c.caster, {.set = LineSet::Bundles, .linesPerBundle = 1U << 21}), UsageError);
    EXPECT_THROW(GlobalLines(c.mesh, c.caster, {.chordsPerBlock = 0}), UsageError);
    EXPECT_THROW(GlobalLines(c.mesh, c.caster, {.chordsPerBlock = 1U << 21}), UsageError);
}

} // namespace
} // namespace lambert
