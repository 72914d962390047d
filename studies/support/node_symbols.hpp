#pragma once

#include <vector>

#include "problems/core/symbol.hpp"
#include "problems/core/transient_problem.hpp"
#include "studies/support/run_case.hpp"

namespace strongpoint {

/// The symbols of a problem of waves at nodes inside a cloud.
template <int Dim>
struct WaveSymbols {
  ExactSymbol<Dim> exact;
  std::vector<NodeSymbol<Dim>> nodes;
  double spacing;        ///< of the cloud, see `mean_spacing`
  int cloud_size;        ///< nodes
  double cloud_spacing;  ///< (measure/N)^(1/Dim)
};

/// Spacing that wavenumbers are counted in: of a structured cloud (measure / cells)^(1/Dim), which
/// is the spacing of a uniform grid; measure / (N - 1) of any cloud in 1D; elsewhere (measure /
/// N)^(1/Dim).
template <int Dim>
double mean_spacing(const PointCloud<Dim>& cloud);

/// The symbols at the `count` inner nodes nearest to the middle of the domain, the image of the
/// middle of the unit cube, or at all if there are fewer. Only the stencils that their equations
/// read are chosen, and only their weights computed. The exact symbol is that of the place of the
/// nearest of them. Throws SkipCase and CaseError.
template <int Dim>
WaveSymbols<Dim> node_symbols(const TransientProblem<Dim>& problem, const CaseKey& key, int count,
                              const RunOptions& options);

}  // namespace strongpoint
