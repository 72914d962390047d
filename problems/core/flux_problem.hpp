#pragma once

#include "problems/core/problem.hpp"

namespace strongpoint {

/// What a side of the boundary says about a field: its value, or its flux through the side.
enum class Known { value, flux };

/// A steady problem in the form div sigma = f, one flux sigma_i and one source f_i a field: what
/// forms that integrate take it from. The same solution satisfies `equations`.
template <int Dim>
class FluxProblem : public SteadyProblem<Dim> {
 public:
  /// Adds sum_j sigma_ij direction_j, the flux of field i along a direction of any length, in the
  /// `flux_derivatives`.
  virtual void flux(int field, const Place<Dim>& place, const Point<Dim>& direction,
                    EquationWriter<Dim>& write) const = 0;
  /// Derivatives that fluxes read.
  virtual Derivatives<Dim> flux_derivatives() const {
    return Derivatives<Dim>::between_orders(1, 1);
  }
  /// True when the coefficients of a flux are the same at all places of a patch.
  virtual bool has_even_flux() const { return false; }
  /// False for a field whose equation is no balance of a flux and holds point by point.
  virtual bool has_flux(int) const { return true; }
  /// The source f_i at a place.
  virtual double source(int field, const Place<Dim>& place) const = 0;
  /// The inertia of a field at a place, mass over volume: in time div sigma = f + inertia u''.
  virtual double inertia(int, const Place<Dim>&) const { return 0; }
  /// What is known of a field on a side. Where sides meet, a given value wins.
  virtual Known known(int field, int side) const = 0;
  /// The value known at a point of a side, or the flux sum_j sigma_ij n_j through it, n being the
  /// outward unit normal.
  virtual double given(int field, int side, const Point<Dim>& x) const = 0;
};

}  // namespace strongpoint
