#include "core/checksum.h"
#include "core/stopwatch.h"
#include "formfactors/matrix_quality.h"
#include "lighting/light_solves.h"
#include "solver/computed_rows.h"
#include "solver/solution_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lambert {

namespace {

/// `formFactors` names what the rows depend on, in one line.
void solveWith(const FormFactorLight& method, const LightTask& task, FormFactorRows& rows,
               const std::string& formFactors) {
    const auto run = [&](const SolverProblem& problem, std::span<const RgbSum> start, const SolverOptions& solver) {
        SolverContext context{start};
        context.checkpoint =
            nextCheckpoint(task, fmt::format("{}; {}", formFactors, solverIdentity(problem, solver, context)));
        return solve(problem, rows, solver, task.progress, context);
    };
    std::vector<RgbSum> start;
    if (!method.warmStart.empty()) start = readStart(method.warmStart, task.scene.mesh, task.scene.scene->origin);
    task.scene.solution = run(task.problem, start, method.solver);
    task.scene.largestResidual = task.scene.solution.residual;
    SolverOptions solver = method.solver;
    solver.keepBounces = false;
    solveLights(task, [&](const SolverProblem& light) { return run(light, {}, solver); });
}

std::string checksumOf(const FormFactorMatrix& matrix) {
    Checksum sum;
    std::vector<std::byte> row;
    for (std::size_t patch = 0; patch < matrix.size(); ++patch) {
        row.clear();
        matrix.appendBytes(patch, row);
        sum.add(row);
    }
    return fmt::format("{:016x}", sum.value());
}

void measureRows(const FormFactorMatrix& matrix, FormFactorsUsed& used) {
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        used.largestClosureError = std::max(used.largestClosureError, std::abs(matrix.row(i).sum() - 1.0));
        const auto error = static_cast<double>(matrix.error(i));
        used.meanError += error / static_cast<double>(matrix.size());
        used.largestError = std::max(used.largestError, error);
    }
    used.entries = matrix.entryCount();
    used.bytes = matrix.bytes();
}

/// The matrix first, then the light.
void findStored(const FormFactorLight& method, const LightTask& task, FormFactorsUsed& used) {
    SolvedScene& scene = task.scene;
    const CheckpointOptions& checkpoint = task.options.checkpoint;
    Stopwatch watch;
    SceneMatrix obtained = obtainMatrix(method.formFactors, checkpoint, scene.mesh, *scene.rays, task.progress);
    const FormFactorMatrix& matrix = obtained.matrix;
    used.plan = std::move(obtained.plan);
    used.repair = std::move(obtained.repair);
    measureRows(matrix, used);
    scene.matrixCheckpoint = std::move(obtained.checkpoint);
    scene.rayCount = used.plan ? used.plan->rays : 0;
    const std::vector<double> deficit =
        used.repair ? std::move(obtained.deficit) : columnDeficit(matrix, scene.mesh.area);
    scene.seconds.formFactors = watch.lap();
    StoredRows rows(matrix);
    solveWith(method, task, rows,
              fmt::format("lambert {}, form factors {}", checkpoint.version,
                          checkpoint.path.empty() ? std::string() : checksumOf(matrix)));
    scene.energyCheck = checkEnergy(scene, deficit, lossOfEmitters(scene, matrix));
    scene.seconds.solve = watch.lap();
}

/// Rows are computed as the solver asks for them.
void findComputed(const FormFactorLight& method, const LightTask& task, FormFactorsUsed& used) {
    SolvedScene& scene = task.scene;
    Stopwatch watch;
    used.plan = planTransport(method.formFactors.transport, scene.mesh, *scene.rays, task.progress);
    const auto transport = makeMethod(*used.plan, scene.mesh, *scene.rays);
    ComputedRows rows(*transport);
    solveWith(method, task, rows,
              matrixIdentity(*used.plan, scene.mesh, *scene.scene, task.options.checkpoint.version));
    scene.rayCount = rows.rowsComputed() * transport->raysPerRow();
    used.largestClosureError = rows.largestClosureError();
    scene.seconds.solve = watch.lap();
}

} // namespace

void findLight(const FormFactorLight& method, const LightTask& task) {
    auto& used = task.scene.account.emplace<FormFactorsUsed>();
    (method.formFactors.transport.stored ? findStored : findComputed)(method, task, used);
    if (!task.scene.energyCheck.beforeRepair && method.solver.bounces == 0)
        task.scene.energyCheck = checkEnergy(task.scene);
}

} // namespace lambert
