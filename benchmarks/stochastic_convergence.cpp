/// How the error of stochastic relaxation falls with its rays: against a converged solution of the same mesh, and at points whose
/// irradiance is known. scripts/stochastic_convergence.py runs it on variants of a scene.

#include "baking/bake_scene.h"
#include "baking/probe.h"
#include "scene/reading/scene_reader.h"
#include "solver/stochastic_relaxation.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace lambert {
namespace {

struct Reference {
    ProbePoint point;
    RgbSum irradiance{0.0};
    RgbSum reflectance{0.0};
};

/// Rows of x,y,z,nx,ny,nz,E_r,E_g,E_b in metres; # starts a comment.
std::vector<Reference> readReference(const std::string& path, const RayCaster& rays) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + " cannot be read");
    std::vector<Reference> result;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream numbers(line);
        double v[9] = {};
        for (double& value : v) {
            numbers >> value;
            numbers.ignore(1, ',');
        }
        Reference r;
        r.point = {glm::vec3(v[0], v[1], v[2]), glm::vec3(v[3], v[4], v[5])};
        r.irradiance = {v[6], v[7], v[8]};
        const float above = 1e-3F * rays.bounds().diagonal();
        const auto hit = rays.closest({r.point.position + above * r.point.normal, -r.point.normal});
        const Scene& scene = rays.scene();
        if (hit) r.reflectance = scene.materials[scene.polygons[hit->polygon].material].reflectance;
        result.push_back(r);
    }
    return result;
}

/// RMS of the difference of ρE over the mean of ρE, as the figures of other programs are given; of green light.
double errorAtPoints(SolvedScene& scene, const std::vector<Reference>& reference) {
    if (reference.empty()) return 0.0;
    std::vector<ProbePoint> points;
    for (const Reference& r : reference) points.push_back(r.point);
    Progress progress;
    const std::vector<ProbeReading> readings = probeIrradiance(scene, {}, points, progress);
    double squares = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        const double difference = readings[i].irradiance.y - reference[i].irradiance.y;
        squares += std::pow(reference[i].reflectance.y * difference, 2.0);
        sum += reference[i].reflectance.y * reference[i].irradiance.y;
    }
    const auto count = static_cast<double>(reference.size());
    return std::sqrt(squares / count) / (sum / count);
}

/// sqrt(Σ A |E − E'|²) / sqrt(Σ A |E'|²).
double errorToConverged(const PatchMesh& mesh, const RadiositySolution& solution, const RadiositySolution& converged) {
    double squares = 0.0, all = 0.0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const auto area = static_cast<double>(mesh.area[i]);
        const RgbSum difference = solution.irradiance[i] - converged.irradiance[i];
        squares += area * glm::dot(difference, difference);
        all += area * glm::dot(converged.irradiance[i], converged.irradiance[i]);
    }
    return std::sqrt(squares / all);
}

/// Of all threads.
double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Arguments {
    std::string scene, points;
    std::vector<std::string> kinds{"local"};
    std::size_t patches = 5000, finePatches = 0;
    double fewest = 1.4e5, most = 1.4e7, factor = std::sqrt(10.0), converged = 4e8;
    int seeds = 3;
    bool random = false;
};

SolvedScene meshed(const Arguments& a, std::size_t patches) {
    MeshOptions options;
    options.patches = patches;
    Progress progress;
    return SolvedScene{meshLitScene(readScene(a.scene).scene, options, progress)};
}

/// Replaces the irradiance of the points by that of a solution on a finer mesh, and drops those that are on no surface.
void takeFromFinerMesh(const Arguments& a, std::vector<Reference>& reference) {
    SolvedScene fine = meshed(a, a.finePatches);
    Progress progress;
    fine.solution =
        solveStochasticRelaxation(SolverProblem({fine.mesh, fine.optics}), fine.mesh, *fine.rays,
                                  {.rays = static_cast<std::uint64_t>(a.converged), .seed = 2000}, progress);
    std::vector<ProbePoint> points;
    for (const Reference& r : reference) points.push_back(r.point);
    const std::vector<ProbeReading> readings = probeIrradiance(fine, {}, points, progress);
    std::vector<Reference> kept;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        reference[i].irradiance = readings[i].irradiance;
        if (readings[i].onSurface) kept.push_back(reference[i]);
    }
    reference = std::move(kept);
}

void run(const Arguments& a) {
    Progress progress;
    SolvedScene scene = meshed(a, a.patches);
    std::vector<Reference> reference =
        a.points.empty() ? std::vector<Reference>{} : readReference(a.points, *scene.rays);
    if (a.finePatches > 0) takeFromFinerMesh(a, reference);
    const auto solve = [&](double rays, std::uint64_t seed, const std::string& kind) {
        StochasticRelaxationOptions o;
        o.lines = kind == "local" ? RelaxationLines::Local : RelaxationLines::Global;
        o.lineSet = kind == "bundles" ? LineSet::Bundles : LineSet::Chords;
        o.sampler = a.random ? Sampler::Random : Sampler::Sobol;
        o.rays = static_cast<std::uint64_t>(rays);
        o.seed = seed;
        return solveStochasticRelaxation(SolverProblem({scene.mesh, scene.optics}), scene.mesh, *scene.rays, o,
                                         progress);
    };
    const StochasticSolution converged = solve(a.converged, 1000, "local");
    scene.solution = converged;
    fmt::print("# {}, {} patches; converged to {:.3g} with {:.3g} rays, where the {} points err by {:.4f}\n", a.scene,
               scene.mesh.size(), converged.relativeError, static_cast<double>(converged.rays), reference.size(),
               errorAtPoints(scene, reference));
    fmt::print("# lines,rays,CPU seconds,stated error,error to converged,error at points (RMS of {} seeds)\n", a.seeds);
    for (const std::string& kind : a.kinds) {
        for (double rays = a.fewest; rays < 1.001 * a.most; rays *= a.factor) {
            double count = 0.0, seconds = 0.0, stated = 0.0, toConverged = 0.0, atPoints = 0.0;
            for (int seed = 1; seed <= a.seeds; ++seed) {
                const double before = cpuSeconds();
                const StochasticSolution solution = solve(rays, static_cast<std::uint64_t>(seed), kind);
                seconds += (cpuSeconds() - before) / a.seeds;
                count += static_cast<double>(solution.rays) / a.seeds;
                stated += std::pow(solution.relativeError, 2.0) / a.seeds;
                toConverged += std::pow(errorToConverged(scene.mesh, solution, converged), 2.0) / a.seeds;
                scene.solution = solution;
                atPoints += std::pow(errorAtPoints(scene, reference), 2.0) / a.seeds;
            }
            fmt::print("{},{:.0f},{:.3f},{:.5f},{:.5f},{:.5f}\n", kind, count, seconds, std::sqrt(stated),
                       std::sqrt(toConverged), std::sqrt(atPoints));
            std::fflush(stdout);
        }
    }
}

} // namespace
} // namespace lambert

int main(int argc, char** argv) {
    lambert::Arguments a;
    CLI::App program("Error of stochastic relaxation against its rays");
    program.add_option("scene", a.scene, "scene file")->required();
    program.add_option("--points", a.points, "CSV of x,y,z,nx,ny,nz,E_r,E_g,E_b, metres");
    program.add_option("--fine", a.finePatches,
                       "patches of a mesh whose converged solution gives E at the points instead");
    program.add_option("--patches", a.patches, "about so many [5000]");
    program.add_option("--lines", a.kinds, "local, chords, bundles; several after each other [local]")
        ->delimiter(',')
        ->check(CLI::IsMember({"local", "chords", "bundles"}));
    program.add_option("--fewest", a.fewest, "rays of the first solution [1.4e5]");
    program.add_option("--most", a.most, "rays of the last solution [1.4e7]");
    program.add_option("--factor", a.factor, "from one to the next [sqrt(10)]");
    program.add_option("--converged", a.converged, "rays of the solution to compare with [4e8]");
    program.add_option("--seeds", a.seeds, "solutions to average over [3]");
    program.add_flag("--random", a.random, "independent rays");
    try {
        program.parse(argc, argv);
        lambert::run(a);
    } catch (const CLI::ParseError& error) {
        return program.exit(error);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
