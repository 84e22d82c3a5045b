#pragma once

#include "baking/baked_mesh.h"
#include "comparison/field_errors.h"
#include "solver/solution_file.h"

#include <array>
#include <vector>

namespace lambert {

struct BakeComparison {
    std::array<FieldErrors, 3> channels;
    FieldErrors overall;           //!< of the mean of the three channels
    bool samePatches = false;      //!< false: B was looked up at the centres of A's patches
    double unmatchedArea = 0.0;    //!< share of A's area where B has no surface; left out
    std::vector<float> difference; //!< #patches of A: |B − A|, mean of the channels; 0 where unmatched
    std::vector<float> excess;     //!< the same of B − A
};

/// How far the light of `other` is from that of `reference`, weighted by the reference's areas. Where their patches are not the
/// same, that of the other at the centre of each patch of the reference. Throws InputError if the other has no
/// surface at more than 1 % of the area.
BakeComparison compareBakes(const StoredSolution& reference, const StoredSolution& other, Quantity quantity);

} // namespace lambert
