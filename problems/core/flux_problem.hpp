#pragma once

#include "problems/core/problem.hpp"

namespace strongpoint {

/// What a side of the boundary says about one field: its value, or its flux through the side.
struct SideCondition {
  enum class Kind { value, flux };
  Kind kind;
  double given;  ///< the value, or sum_j sigma_ij n_j with the outward unit normal n
};

/// A steady problem in the form div sigma = f, one flux sigma_i and one source f_i a field: what
/// forms that integrate take it from. The same solution satisfies `equations`.
template <int Dim>
class FluxProblem : public SteadyProblem<Dim> {
 public:
  /// Adds sum_j sigma_ij direction_j, the flux of field i along a direction of any length, in first
  /// derivatives.
  virtual void flux(int field, const Point<Dim>& direction, EquationWriter<Dim>& write) const = 0;
  /// The source f_i at a point.
  virtual double source(int field, const Point<Dim>& x) const = 0;
  /// The condition on a field at a point of a side. Where sides meet, a given value wins.
  virtual SideCondition condition(int field, int side, const Point<Dim>& x) const = 0;
};

}  // namespace strongpoint
