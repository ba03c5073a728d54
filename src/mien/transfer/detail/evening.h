#pragma once
/// Evens out what a rough correspondence does to displacements.

#include <vector>

#include "mien/geometry/laplacian.h"
#include "mien/transfer/correspondence.h"

namespace mien::detail {

/// Closest points scatter along the surface: of two neighbours one may have its place a little too high, the other too low,
/// which where motion changes fast (a lid) leaves a ragged row. How much shows in the way the places lie: the vector from a
/// vertex to its place differs from the mean of its neighbours' by h edges. The matrix moves each vertex's displacement
/// towards the mean of its neighbours', by 1.4 h and at most .7 of the way; where places lie evenly it changes nothing.
///   points   #V target
///   aligned  #V source x 3: the source after the similarity; triangles: the source's
///   returns  #V x #V, rows sum to one, no entry below zero; vertices that are filled in, or alone, keep what they have
SparseMatrix evening(const std::vector<SourcePoint>& points, const PointsD& aligned,
                     const Triangles& triangles, const Surface& target);

}  // namespace mien::detail
