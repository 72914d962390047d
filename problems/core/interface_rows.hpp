#pragma once

#include "problems/core/flux_problem.hpp"

namespace strongpoint {

/// The flux problem that a steady problem is. Throws SkipCase when it states no fluxes, which
/// interfaces balance.
template <int Dim>
const FluxProblem<Dim>& interface_problem(const SteadyProblem<Dim>& problem);

/// Derivatives that the equations at interfaces read.
template <int Dim>
Derivatives<Dim> interface_derivatives(const FluxProblem<Dim>& problem);

/// Writes the equations of a node on an interface, one per field, with weights for `derivatives`.
/// All but the last of the nodes at a place equal it, field by field. The last one's are
/// - between sides: the fluxes out of all parts, each through its own faces, add up to zero;
/// - where a side is met, values given there; for components left without one inside a patch the
///   side's conditions, its flux taken in the lowest part, of several sides with given tractions
///   the normal component of each; between patches of the domain the normal components of those
///   sides' tractions, in the highest part, and of the balance.
/// A field without a flux keeps its differential equation in every part. Source: thesis 4.2.3 for
/// the multi-patch formulation; the ends of interfaces are ours.
template <int Dim>
void write_interface(const FluxProblem<Dim>& problem, const PointCloud<Dim>& cloud, int node,
                     const Derivatives<Dim>& derivatives, EquationWriter<Dim>& write);

}  // namespace strongpoint
