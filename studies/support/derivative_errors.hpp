#pragma once

#include <string>
#include <vector>

#include "studies/support/run_case.hpp"

namespace strongpoint {

/// Names of the errors of a method's weights on a field: derivative by derivative, first inside,
/// then at the boundary, such as `dx_interior`.
template <int Dim>
std::vector<std::string> derivative_error_names(const FieldProblem<Dim>& problem,
                                                const Method<Dim>& method);

/// Weights of the derivatives of a field that are judged, at every node of the case's cloud: those
/// that the problem names, and the value where a method does not take it from the node. The time of
/// each stage is added to `times`. Throws SkipCase and CaseError.
template <int Dim>
Discretisation<Dim> discretise_field(const FieldProblem<Dim>& problem, const CaseKey& key,
                                     const RunOptions& options, StageTimes& times);

/// Computed minus exact derivatives, relative in the discrete 2-norm over the nodes of a zone, in
/// the order of the names above; no value, and why, where a zone has no nodes or the derivative
/// vanishes on it. With `options.vtk` the size of each error at every node is written.
template <int Dim>
std::vector<Quantity> derivative_errors(const FieldProblem<Dim>& problem, const CaseKey& key,
                                        const RunOptions& options,
                                        const Discretisation<Dim>& scene);

}  // namespace strongpoint
