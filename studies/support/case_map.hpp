#pragma once

#include "problems/core/problem.hpp"
#include "studies/support/run_case.hpp"

namespace strongpoint {

/// The fields at the nodes by their names.
template <int Dim>
std::vector<NodeArray> field_arrays(const SteadyProblem<Dim>& problem,
                                    const Solution<Dim>& solution);

/// `stencil_size` and `condition_two` of each node's own stencil, and the zone, as `case_arrays`
/// has them.
template <int Dim>
std::vector<NodeArray> stencil_arrays(const Discretisation<Dim>& scene, const Method<Dim>& method);

/// What a solved case has at each node, for ParaView: the fields, what the problem derives from
/// them (errors, stresses), `stencil_size` and `condition_two` of the node's own stencil as the
/// study `conditioning` computes them (NaN where the equations read none), and the zone, 1 at the
/// boundary. A method of all nodes has no condition here, which takes long and is no node's own.
template <int Dim>
std::vector<NodeArray> case_arrays(const SteadyProblem<Dim>& problem, const Solution<Dim>& solution,
                                   const Discretisation<Dim>& scene, const Method<Dim>& method);

}  // namespace strongpoint
