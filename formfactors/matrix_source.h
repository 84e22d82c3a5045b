#pragma once

#include "formfactors/matrix_checkpoint.h"
#include "formfactors/repair.h"
#include "formfactors/transport.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lambert {

/// Where the form factors of a scene come from.
struct MatrixSource {
    TransportOptions transport;   //!< how they are computed
    std::filesystem::path file{}; //!< or a matrix file that holds them; empty: computed
    bool repair = false;          //!< made reciprocal and closed afterwards, see repair()
};

struct SceneMatrix {
    FormFactorMatrix matrix;
    std::optional<TransportPlan> plan;            //!< none: from a file
    std::optional<RepairReport> repair;           //!< none: not asked for
    std::vector<double> deficit;                  //!< columnDeficit before the repair; empty: not repaired
    std::unique_ptr<MatrixCheckpoint> checkpoint; //!< to be removed once what is made of the matrix is on the disk
};

/// Reads or computes the form factors of a mesh; those of a file, see readMatrixOf, must sum to 1 in each row within 1 %. `rays` are
/// of `rays.scene()`, which the mesh is of. Throws UsageError, InputError, SystemError, Cancelled.
SceneMatrix obtainMatrix(const MatrixSource& source, const CheckpointOptions& checkpoint, const PatchMesh& mesh,
                         const RayCaster& rays, Progress& progress);

/// A matrix file as the form factors of this mesh. Throws InputError unless it has the mesh's number of patches and, if the file has
/// areas, its areas.
FormFactorMatrix readMatrixOf(const PatchMesh& mesh, const std::filesystem::path& path, MatrixStorage storage);

/// A check sum of all of a scene and its mesh that rays can tell apart, and of the materials.
std::uint64_t sceneChecksum(const PatchMesh& mesh, const Scene& scene);

/// One line that names all that the rows of a planned matrix depend on.
std::string matrixIdentity(const TransportPlan& plan, const PatchMesh& mesh, const Scene& scene,
                           const std::string& version);

} // namespace lambert
