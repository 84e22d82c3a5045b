#pragma once

#include "comparison/compared_points.h"
#include "comparison/point_gather.h"
#include "meshing/mesh_scene.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace lambert {

struct ReferenceOptions {
    MeshOptions mesh;   //!< as that of the compared scene was made
    double lines = 2e8; //!< in all, from the finest mesh; of each patch 1024 to 16384
    int bounces = 0;    //!< how many times reflected light is known apart, see RadiosityReference::byBounce
    std::uint64_t seed = 1;
    std::function<void(const std::string&)> onStage = [](const std::string&) {}; //!< told what begins
};

/// What is known of a reference's distance from the truth, per m² as what it is of. The three are independent of each other.
struct OwnError {
    double mesh = 0.0;      //!< size of the last step of extrapolation: more than what it leaves
    double transport = 0.0; //!< noise of the form factors, from two sets of lines
    double gathering = 0.0; //!< noise of the rays from the points, from two sets of rays
    double total() const;
};

struct ReferenceLight {
    std::vector<RgbSum> irradiance; //!< #points, E per m²
    OwnError rms;                   //!< RMS over points (weighted) and channels
    OwnError mean;                  //!< of the mean over points and channels
    double order = 1.0;             //!< p of the error h^p by which the meshes were extrapolated
    bool orderFound = false;        //!< on three meshes; false: assumed
};

/// Patch radiosity of a scene on three meshes, each with patches half as long as those of the one before, the middle one being
/// the scene's own; of two where polygons are too small to be that coarse. Form factors are counted by local lines, which have
/// no bias.
///
/// Light at points is gathered there (see gatherAtPoints) from all meshes and extrapolated: L. F. Richardson, "The approximate
/// arithmetical solution by finite differences of physical problems", 1911, with the order that three meshes show, kept between 1 and 2.
class RadiosityReference {
public:
    /// `scene` must outlive it. Throws InputError if the scene has no light, SystemError if form factors do not fit into the memory,
    /// Cancelled.
    RadiosityReference(const MeshedScene& scene, const ReferenceOptions& options, Progress& progress);

    ReferenceLight at(std::span<const Receiver> receivers, std::span<const double> weight,
                      const PointGatherOptions& options, Progress& progress) const;

    /// The light that was reflected 0, 1, ... ReferenceOptions::bounces times on its way to the receivers: bounces + 1.
    /// Each is extrapolated by itself.
    std::vector<ReferenceLight> byBounce(std::span<const Receiver> receivers, std::span<const double> weight,
                                         const PointGatherOptions& options, Progress& progress) const;

    std::vector<std::size_t> patches() const;       //!< of the meshes, the coarsest first
    std::uint32_t lines() const { return lines_; }  //!< per patch of the finest mesh
    double imbalance() const { return imbalance_; } //!< of the energy on the mesh where it is largest

private:
    using Field = std::vector<RgbSum>;
    struct Level {
        PatchMesh mesh;
        PatchOptics optics;
        std::vector<Field> irradiance; ///< [0] of all light, [1 + k] of light that was reflected k times
    };
    /// Gathered from [0] of all meshes (or [1 + k]) and from the finest with fewer lines, with two sets of rays.
    struct Gathered {
        std::vector<Field> first, second; ///< #levels + 1
    };
    ReferenceLight extrapolated(const Gathered& gathered, std::span<const double> weight) const;
    const MeshedScene& scene_;
    std::vector<Level> levels_;     ///< the coarsest first
    std::vector<Field> fewerLines_; ///< as Level::irradiance, on the finest mesh, with a quarter of the lines
    std::uint32_t lines_ = 0;
    double imbalance_ = 0.0;
};

} // namespace lambert
