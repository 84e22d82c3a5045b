#pragma once

#include "formfactors/form_factor_matrix.h"

#include <span>
#include <vector>

namespace lambert {

/// How far a matrix is from what every matrix of form factors must keep, whatever the scene. No reference is needed.
struct MatrixIdentities {
    std::vector<float> rowClosure; //!< #patches, |Σ_j F_ij + F_i,back + F_i,out − 1|; 0 for whoever counts lines
    std::vector<float>
        columnClosure; //!< #patches, |Σ_i A_i F_ij / A_j + F_j,back + F_j,out − 1|: what j gets if all send 1
    double rowClosureRms = 0.0;    //!< over the patches, weighted by area
    double columnClosureRms = 0.0; //!< the same
    double reciprocity = 0.0;      //!< RMS of A_i F_ij − A_j F_ji over pairs, relative to the RMS of their mean
};

/// `area` has #patches elements, above 0.
MatrixIdentities matrixIdentities(const FormFactorMatrix& matrix, std::span<const float> area);

} // namespace lambert
