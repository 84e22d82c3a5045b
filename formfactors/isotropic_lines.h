#pragma once

#include "core/sample_points.h"
#include "formfactors/cell_sorter.h"
#include "scene/rays/line_caster.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace lambert {

/// How global lines are spread. Any single line is isotropic and uniform, so that sums over all are unbiased.
enum class LineSet {
    Chords, ///< through pairs of uniform points of the bounding sphere
    Bundles ///< parallel lines through the sphere's disk, one uniform direction after the other
};

struct GlobalLineOptions {
    std::uint32_t lines = 1'000'000;      //!< in all, 1 to 2^32 - 1; one in 2πR²/A crosses a patch of area A
    LineSet set = LineSet::Chords;        //!< bundles are faster to trace, chords are spread better
    std::uint32_t linesPerBundle = 1024;  //!< parallel lines per direction, 1 to 2^20; of bundles
    std::uint32_t chordsPerBlock = 65536; //!< that are put into order together, 1 to 2^20: more are faster to trace
    Sampler sampler = Sampler::Sobol; //!< of the sphere's points, or of directions and of the points within a bundle
    std::uint64_t seed = 1;
};

/// Lines through the sphere around a scene, in blocks of neighbouring lines that are traced as packets.
///
/// M. Sbert, "An integral geometry based method for fast form-factor computation", Computer Graphics Forum 12(3), 1993;
/// chords as in M. Sbert, "The use of global random directions to compute radiosity", PhD thesis, UPC Barcelona 1997.
/// Bundles: C. Buckalew, D. Fussell, "Illumination networks", SIGGRAPH 1989.
class IsotropicLines {
public:
    /// `bounds` of the scene. Throws UsageError for options out of range.
    IsotropicLines(const Bounds& bounds, const GlobalLineOptions& options);

    /// Result of fill(), and its scratch memory; one per thread.
    struct Block {
        std::vector<LinePacket> packets; //!< only the last may have inactive lines

    private:
        friend class IsotropicLines;
        std::vector<float> points;               ///< of the unit cube, dimension by dimension
        std::array<std::vector<float>, 6> lines; ///< origins' and directions' coordinates
        std::vector<std::uint8_t> meets;         ///< whether the line is to be kept
        std::vector<std::uint32_t> kept;
        CellSorter sorter;
    };

    /// Which lines of a block are wanted.
    enum class Keep {
        MeetingBounds, ///< only those that come near the scene's box, two of three; the others cross nothing
        All,
        AllAsDrawn ///< not put into order, to compare with
    };

    std::uint64_t blockCount() const;
    /// Lines of all blocks but the last.
    std::uint32_t linesPerBlock() const;
    /// Lines of the first `blocks` blocks.
    std::uint64_t linesBefore(std::uint64_t blocks) const;
    /// Lines of a block, the same for the same options; neighbours follow each other but for AllAsDrawn.
    void fill(std::uint64_t block, Block& result, Keep keep = Keep::MeetingBounds) const;

    /// Of the bounding sphere (metres), 1e-4 larger than needed: a patch of area A is crossed with probability A / (2πR²).
    float radius() const { return radius_; }

private:
    static void pack(Block& result, std::span<const std::uint32_t> order);
    void makeChords(std::uint32_t first, std::uint32_t count, Block& result) const;
    void makeBundle(std::uint32_t bundle, std::uint32_t count, Block& result) const;

    glm::vec3 centre_;
    glm::vec3 halfSize_; ///< of the scene's box, a little enlarged
    float radius_;
    GlobalLineOptions options_;
    SamplePoints points_; ///< of chords: both ends; of bundles: their directions
};

} // namespace lambert
