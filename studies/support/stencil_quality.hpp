#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "studies/support/run_case.hpp"

namespace strongpoint {

/// One number for each anchor of a scene, or the reason why there is none.
struct PerAnchor {
  std::vector<double> values;  ///< (anchors), NaN where no stencil is wanted; empty with a reason
  std::string reason;
};

/// How numbers are distributed: percentiles are the smallest numbers that at least this share do
/// not exceed.
struct Spread {
  double least, median, p99, most;
};

/// The distribution of some numbers, infinite ones included. Throws std::invalid_argument for none.
Spread spread_of(std::vector<double> values);

/// Nodes in each anchor's row of weights or, as long as there are none, in its stencil; every node
/// of the cloud with a method that uses them all.
template <int Dim>
PerAnchor stencil_sizes(const Discretisation<Dim>& scene, const Method<Dim>& method);

/// Condition of the scaled local matrix of each wanted anchor, infinite where it is singular.
template <int Dim>
PerAnchor stencil_conditions(const Discretisation<Dim>& scene, const Method<Dim>& method,
                             Scaling scaling, ConditionNorm norm);

/// The same of some wanted anchors alone, NaN at the others.
template <int Dim>
PerAnchor stencil_conditions(const Discretisation<Dim>& scene, const Method<Dim>& method,
                             const std::vector<int>& anchors, Scaling scaling, ConditionNorm norm);

/// A Lebesgue number of each anchor's weights: h^q sum_j |w_j|, the largest over the derivatives
/// of order q in the scene, h being the spacing of the cloud (one for all stencils, so that a
/// graded cloud has large numbers where it is fine). Dimensionless; it bounds by how much errors of
/// the nodal values are amplified, in units of h^-q. Where nodes are h apart, three-point
/// differences have 1 (q = 1) and 4 (q = 2).
template <int Dim>
PerAnchor lebesgue_numbers(const Discretisation<Dim>& scene, int order);

/// The Laplacian's weight of each anchor's own node over the sum of the absolute values of all, 0
/// where that node is not in the stencil. With weights that sum to zero it is -1/2 where no other
/// weight is negative, which gives a discrete maximum principle, and above it otherwise; a value
/// that is not negative takes the ellipticity away.
template <int Dim>
PerAnchor laplacian_centres(const Discretisation<Dim>& scene);

/// How badly each anchor's weights differentiate the monomials up to a degree: with z = (x_j - x)/R
/// and W_j = R^q w_j, the largest |sum_j W_j p(z_j) - D p(0)| / max(sum_j |W_j|, |D p(0)|) over
/// derivatives and monomials. No monomial exceeds one on the stencil, so that round-off gives about
/// 1e-16 times the condition, whatever the spacing.
template <int Dim>
PerAnchor reproduction_residuals(const Discretisation<Dim>& scene, int degree);

/// The limit that a `grow_until` rule sets to the condition, and how it measures it.
struct ConditionLimit {
  double most;
  Scaling scaling;
  ConditionNorm norm;
};

/// The limit that a stencil rule keeps in a zone: of `grow_until`, also as a part of `zoned`; none
/// with rules that judge no condition.
std::optional<ConditionLimit> condition_limit(const std::string& stencil, Zone zone);

}  // namespace strongpoint
