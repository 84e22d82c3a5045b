#pragma once

#include "comparison/compared_methods.h"

#include <filesystem>
#include <optional>
#include <string>

namespace lambert {

/// What the methods are compared with.
struct ReferenceChoice {
    enum class Kind {
        Automatic, ///< exact where the scene is convex, else closed forms with hidden parts
        Exact,     ///< pair by pair in closed form, of a scene in which nothing hides anything
        Method,
        File
    };
    Kind kind = Kind::Automatic;
    const ComparedMethod* method = nullptr; //!< of kind Method
    double effort = 0.0;                    //!< the same
    std::filesystem::path file;             //!< of kind File
};

/// auto, exact, METHOD:EFFORT, or a matrix file's name. Throws UsageError.
ReferenceChoice parseReference(const std::string& text);

struct ReferenceMatrix {
    std::string description; //!< for people: "local lines, 262144 lines per patch, mean of two"
    FormFactorMatrix matrix; //!< in double
    /// Relative RMS error of its own factors above the threshold: from two independent halves, or what a method aims at that has
    /// no chance in it; none if it is not known.
    std::optional<double> ownError;
};

/// Whether every polygon has all others on its front or in its plane, so that none can stand between two others.
bool isConvex(const Scene& scene);

/// Factors of all pairs of patches by closed form, as if nothing stood between them; what a row lacks of 1 leaves the scene.
FormFactorMatrix unoccludedMatrix(const PatchMesh& mesh, Progress& progress);

/// Computes or reads the reference. A random method's is the mean of two matrices of seeds that no compared run has. Throws UsageError
/// for `exact` in a scene that is not convex, InputError for a file that does not fit the mesh, Cancelled.
ReferenceMatrix makeReference(const ReferenceChoice& choice, const MeshedScene& scene, std::uint64_t seed,
                              double threshold, Progress& progress);

} // namespace lambert
