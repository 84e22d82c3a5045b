#pragma once

#include "core/progress.h"
#include "core/sample_points.h"
#include "formfactors/form_factor_matrix.h"
#include "formfactors/form_factor_method.h"
#include "formfactors/isotropic_lines.h"
#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

class MatrixCheckpoint;

/// The one place where a way to compute form factors is made from its name and options: what a new method needs beside its
/// own files is a line in each table and switch of transport.cpp.
enum class TransportMethod { Auto, Hemicube, Hemisphere, LocalLines, GlobalLines, ClosedForm };

std::optional<TransportMethod> methodByName(std::string_view name);
std::string_view nameOf(TransportMethod method);
std::vector<std::string> methodNames();
bool hasResolution(TransportMethod method); ///< TransportOptions::resolution and below count
bool hasLines(TransportMethod method);      ///< TransportOptions::lines and below count
bool hasRows(TransportMethod method);       ///< computes row by row, see makeMethod
bool hasPointRows(TransportMethod method);  ///< see FormFactorMethod::pointRow

struct TransportOptions {
    TransportMethod method = TransportMethod::Auto;

    std::optional<int> resolution; //!< of hemicubes and hemispheres, see there; none: chosen by the bounds below
    int perPatch = 1;              //!< hemicubes or hemispheres per patch
    bool randomRotation = true;    //!< of these

    std::optional<std::uint32_t>
        lines; //!< local: per patch, global: in all; see there; none: a power of two by the bounds
               //!< below
    Sampler sampler = Sampler::Sobol;  //!< of lines
    LineSet lineSet = LineSet::Chords; //!< of global lines

    double rowError = 0.01;               //!< of auto: Σ_j |ΔF_ij| aimed at, see VisibilitySamplingOptions::error
    std::uint32_t mostRaysPerRow = 65536; //!< filled in by a plan, from mostRays
    double error = 1e-4;                  //!< of the closed form, see there

    std::uint64_t seed = 1;
    bool stored = true;                   //!< false: rows are computed whenever they are asked for, no matrix is made
    std::optional<MatrixStorage> storage; //!< none: float while it fits the memory, else compact
    std::uint64_t memoryLimit = std::uint64_t{8} << 30; //!< bytes for the form factors

    /// Of hemicubes where none is given, 16 to 4096; other methods take about as many rays.
    int largestResolution = 128;
    double mostRays = 1.3e9; //!< in all, where effort is not given: a few minutes on two cores
};

/// What a computation is going to take.
struct TransportPlan {
    TransportOptions options;   //!< with the method's resolution or lines, and the storage (if stored), filled in
    std::uint64_t rays = 0;     //!< in all
    double bytes = 0.0;         //!< of the matrix, about; of small ones an upper bound; 0 without one
    std::string effort() const; //!< "hemicube, resolution 128", for logs
};

/// Throws UsageError for what can be known to be wrong without a mesh.
void checkTransport(const TransportOptions& options);

/// Fills in what is not given: the largest effort within the three bounds, and the storage; where rays between all pairs
/// would be too many for `auto`, its place is taken by local lines. Computes some rows where a
/// dense matrix would not fit. Throws UsageError, SystemError if the matrix would not fit memoryLimit, Cancelled.
TransportPlan planTransport(const TransportOptions& options, const PatchMesh& mesh, const RayCaster& rays,
                            Progress& progress);

/// A planned method that computes rows (see hasRows). `mesh` and `rays` must outlive it.
std::unique_ptr<FormFactorMethod> makeMethod(const TransportPlan& plan, const PatchMesh& mesh, const RayCaster& rays);

struct TransportMatrix {
    FormFactorMatrix matrix;
    std::vector<double> repairWeights; //!< #patches, see repair()
    std::uint64_t rays = 0;            //!< in all
};

/// The matrix. With a checkpoint, what that holds is taken from it, and all else entered as it is finished. Throws Cancelled; of
/// the checkpoint InputError, SystemError.
TransportMatrix computeMatrix(const TransportPlan& plan, const PatchMesh& mesh, const RayCaster& rays,
                              Progress& progress, MatrixCheckpoint* checkpoint = nullptr);

/// Weights of rows that are computed alike.
std::vector<double> repairWeights(const PatchMesh& mesh);

} // namespace lambert
