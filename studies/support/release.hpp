#pragma once

#include <cstddef>
#include <span>

#include "problems/core/problem.hpp"
#include "studies/support/discretise.hpp"

namespace strongpoint {

/// The weights of some derivatives, given by their positions in `weights`, ascending; the pattern
/// stays.
Weights weights_of(const Weights& weights, std::span<const int> slots);

/// Bytes that are worth freeing: copying what stays takes longer than all else of a small scene.
inline constexpr std::size_t worth_freeing = std::size_t{1} << 26;

/// Frees what no measure of the problem reads once the system stands: stencils, and the weights of
/// derivatives that are not measured, when these are at least so many bytes. The scene's
/// derivatives are those that are left.
template <int Dim>
void release_unread(const SteadyProblem<Dim>& problem, Discretisation<Dim>& scene,
                    std::size_t least_bytes = worth_freeing);

}  // namespace strongpoint
