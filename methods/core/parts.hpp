#pragma once

#include <vector>

#include "methods/core/method.hpp"
#include "methods/core/sites.hpp"
#include "methods/core/weights.hpp"

namespace strongpoint {

/// The sites of one part with ids of their own, for rules and methods, which know of no parts.
template <int Dim>
struct PartSites {
  Sites<Dim> sites;
  std::vector<int> nodes;    ///< (nodes of the part) ids in the whole, ascending
  std::vector<int> anchors;  ///< (anchors of the part) likewise
  std::vector<int> points;   ///< (points of the part) likewise
};

/// The sites of each part. Throws CaseError when node_part or anchor_part has another length than
/// there are nodes or anchors.
template <int Dim>
std::vector<PartSites<Dim>> split_by_part(const Sites<Dim>& sites);

/// Stencils of all anchors, with ids of the whole, from those of the parts.
template <int Dim>
Stencils join_stencils(const std::vector<PartSites<Dim>>& parts,
                       const std::vector<Stencils>& stencils);

/// Weights of all points, with ids of the whole, from those of the parts.
template <int Dim>
Weights join_weights(const std::vector<PartSites<Dim>>& parts, const std::vector<Weights>& weights);

/// Method::weights on sites of one part or several.
template <int Dim>
Weights weights_by_part(const Method<Dim>& method, const Sites<Dim>& sites,
                        const Stencils& stencils, const Derivatives<Dim>& derivatives);

/// Method::condition on sites of one part or several.
template <int Dim>
std::vector<double> condition_by_part(const Method<Dim>& method, const Sites<Dim>& sites,
                                      std::span<const int> anchors, const Stencils& stencils,
                                      Scaling scaling, ConditionNorm norm);

}  // namespace strongpoint
