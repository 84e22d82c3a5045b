#pragma once

namespace lambert {

/// What predictions add to what pilots time and count: costs as they were on a machine of two cores. All are a small part of a bake.
/// To measure one anew, bake a room with --json at two numbers of patches on a quiet machine: seconds and peak memory differ by
/// the constant times the difference of what it is per.

inline constexpr double kReconstructionSeconds = 5e-6; //!< per patch
inline constexpr double kWriteSeconds = 5e-6;          //!< per patch and output
inline constexpr double kSolveSeconds = 3e-9;          //!< per form factor and iteration, one thread
inline constexpr double kPictureRay = 2.0; //!< a picture's ray and the light where it ends, in rays of a hemicube

inline constexpr double kSolveBytes = 300.0; //!< per patch, beside the mesh: solution and iterates
inline constexpr double kLineSolveBytes =
    152.0;                                  //!< the same of solvers by lines; 12 of them were counted, not measured
inline constexpr double kBakeBytes = 180.0; //!< thereafter: solution and reconstruction
inline constexpr double kRowBytes = 32.0;   //!< per row of form factors: the allocator's, and what rounding up costs
inline constexpr double kReceiverBytes = 150.0; //!< per point at which light is gathered
inline constexpr double kLightBytes = 250.0;    //!< per virtual point light

} // namespace lambert
