#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/max_entropy.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

/// The prior, or the distribution itself with order 2, has fallen to this at the end of a stencil.
constexpr double negligible = 1e-8;
/// Reach of a blend in spacings: the strip of the B-splines on uneven nodes, and beyond it enough
/// to know that no more nodes follow.
constexpr double blend_reach = 8.2;

double reach(const MaxEntropyOptions& options) {
  if (options.boundary == MaxEntropyBoundary::bspline) return blend_reach;
  return std::max(2.1, std::sqrt(-std::log(negligible) / options.locality()));
}

}  // namespace

/// Local maximum-entropy functions of first and second order, differentiated at the nodes.
/// Source: Arroyo & Ortiz 2006; Cyron, Arroyo, Ortiz 2009; Rosolen & Arroyo 2013; thesis 1.3.3, in
/// which (1.56) and (1.58) refer to log Z and (1.51) is read as MaxEntropy says. The locality is
/// one number for a stencil, beta over the squared local spacing. Linear fields are reproduced; the
/// second derivatives of order 1 are not consistent: Poisson's equation keeps a relative error of
/// 0.0006 on a grid with beta = 0.8 (0.014 with 1.2, 0.08 with 1.8, as the variance of the sampled
/// bell oscillates between the nodes) and of 0.009 on nodes perturbed by 20 %. Those of order 2 are
/// consistent, and a gap of 0.6 keeps second order there, where a smaller one gives centres the
/// wrong sign. A large beta makes derivatives at the boundary lose digits, too: linear fields are
/// exact to 1e-10 with beta = 4 and to 3e-7 with 10, relative to the sum of the terms' sizes.
MethodEntry method_max_ent() {
  return {{"max_ent",
           "local maximum-entropy functions, first and second order",
           {{"order", "1", "of the moments prescribed, 1, or 2 in 1D and 2D"},
            {"beta", "0.8", "locality times the squared local spacing, with order=1, 0.1 to 10"},
            {"gap", "0.6", "variance over the squared spacing, with order=2, above 0.25 to 2"},
            {"inset", "0.5", "how far inside a boundary node's derivatives are taken, 0.01 to 1"},
            {"boundary", "hull", "functions at the boundary: hull | bspline (in 1D)"}}},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>,
                                                 Options& text) -> std::unique_ptr<Method<Dim>> {
            MaxEntropyOptions options;
            options.order = text.integer("order", 1, 2);
            options.beta = text.number("beta", 0.1, 10);
            options.gap = text.number("gap", 0.2501, 2);
            options.inset = text.number("inset", 0.01, 1);
            options.boundary = text.choice<MaxEntropyBoundary>(
                "boundary",
                {{"hull", MaxEntropyBoundary::hull}, {"bspline", MaxEntropyBoundary::bspline}});
            using Made = LocalMethod<Dim, MaxEntropy<Dim>>;
            const Promises promises{.reproduces = 1, .interpolates = false};
            const int least = static_cast<int>(std::lround(std::pow(3, Dim))) + 3 * options.order;
            return std::make_unique<Made>(
                MaxEntropy<Dim>(options),
                typename Made::Traits{"max_ent", promises, Needs{.spacing = true}, least,
                                      fmt::format("radius[factor={:.4g}]", reach(options))});
          })};
}

}  // namespace strongpoint
