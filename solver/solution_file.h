#pragma once

#include "meshing/mesh_scene.h"
#include "solver/solution.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace lambert {

/// Where a solution comes from.
struct SolutionOrigin {
    std::string scene;  //!< path, as it was named
    std::string method; //!< of the form factors
    std::string solver;
};

/// What a solution file is made of, see docs/solution.md. `scene` must have the materials of `mesh`.
struct SolutionRecord {
    const Scene& scene;
    const PatchMesh& mesh;
    const PatchOptics& optics;
    const RadiositySolution& solution;
    std::span<const Rgb> standardError; //!< #patches, of the irradiance; or empty
    SolutionOrigin origin;
    std::string version; //!< of Lambert, named as the generator
};

/// Throws UsageError unless the name ends in .glb.
void requireSolutionName(const std::filesystem::path& path, const char* option);

/// Writes the patches and their light as a GLB, whole or not at all: the same bytes for the same solution, whatever time it
/// took. Values are rounded to single precision. Throws SystemError if the file cannot be written, would exceed 2^32 bytes, or
/// would hold a value that is not finite.
void writeSolution(const SolutionRecord& record, const std::filesystem::path& path);

/// A solution that was read.
struct StoredSolution {
    /// Patches as they were solved, with all arrays but occluderEdges; `polygon` is into the scene's, which are the patches'
    /// triangles (kNone for patches that are one hole). Materials of the scene have a name and nothing else. Without `rays`.
    MeshedScene meshed;
    RadiositySolution solution; //!< in single precision; history without seconds
    std::vector<Rgb> standardError;
    SolutionOrigin origin;
};

/// Reads a solution file, whoever wrote it. Throws InputError, with the file and the place in it, for what
/// is no solution or contradicts itself.
StoredSolution readSolution(const std::filesystem::path& path);

/// The irradiances of a solution file, #patches, as the start of a solver. Throws InputError as readSolution, and unless its
/// patches are those of `mesh`, of a scene with this `origin`: reflectances and emission may be others.
std::vector<RgbSum> readStart(const std::filesystem::path& path, const PatchMesh& mesh, const glm::dvec3& origin);

} // namespace lambert
