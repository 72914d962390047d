#include "studies/support/stencil_quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "methods/core/monomial.hpp"
#include "methods/core/parts.hpp"

namespace strongpoint {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Fills in what `of_point(point)` gives wherever a point has weights.
template <int Dim, class OfPoint>
PerAnchor at_points(const Discretisation<Dim>& scene, OfPoint&& of_point) {
  PerAnchor result{std::vector<double>(scene.sites.anchor_count(), none), ""};
  for (int p = 0; p < scene.weights.size(); ++p) {
    if (!scene.weights.nodes(p).empty()) result.values[scene.sites.point_anchor[p]] = of_point(p);
  }
  return result;
}

/// The nodes of a row about their point, in units of the row's radius R.
template <int Dim>
struct ScaledRow {
  double radius = 0;
  Points<Dim> z;

  ScaledRow(const Discretisation<Dim>& scene, int point) {
    const std::span<const int> nodes = scene.weights.nodes(point);
    z.resize(Dim, static_cast<Eigen::Index>(nodes.size()));
    for (Eigen::Index j = 0; j < z.cols(); ++j) {
      z.col(j) = scene.sites.nodes.col(nodes[j]) - scene.sites.points.col(point);
    }
    radius = z.cols() > 0 ? z.colwise().norm().maxCoeff() : 0;
    if (radius > 0) z /= radius;
  }
};

/// (monomials, nodes) z^alpha.
template <int Dim>
Eigen::MatrixXd monomials_at(const Points<Dim>& z, const Derivatives<Dim>& monomials) {
  Eigen::MatrixXd values(monomials.size(), z.cols());
  for (Eigen::Index j = 0; j < z.cols(); ++j) {
    for (int a = 0; a < monomials.size(); ++a) {
      values(a, j) = monomial_derivative<Dim>(monomials[a], MultiIndex<Dim>{}, z.col(j));
    }
  }
  return values;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("the spread of no numbers was asked for");
  std::sort(values.begin(), values.end());
  const auto percentile = [&](double share) {
    const auto rank = std::ceil(share * static_cast<double>(values.size()));
    return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
  };
  return {values.front(), percentile(0.5), percentile(0.99), values.back()};
}

template <int Dim>
PerAnchor stencil_sizes(const Discretisation<Dim>& scene, const Method<Dim>& method) {
  PerAnchor result{std::vector<double>(scene.sites.anchor_count(), none), ""};
  const bool global = method.default_stencil() == every_node;
  for (int a : scene.sites.wanted_anchors()) {
    const std::size_t nodes = global ? scene.sites.node_count() : scene.stencils[a].size();
    result.values[a] = static_cast<double>(nodes);
  }
  if (scene.weights.size() == 0) return result;
  return at_points(scene,
                   [&](int p) { return static_cast<double>(scene.weights.nodes(p).size()); });
}

template <int Dim>
PerAnchor stencil_conditions(const Discretisation<Dim>& scene, const Method<Dim>& method,
                             Scaling scaling, ConditionNorm norm) {
  return stencil_conditions<Dim>(scene, method, scene.sites.wanted_anchors(), scaling, norm);
}

template <int Dim>
PerAnchor stencil_conditions(const Discretisation<Dim>& scene, const Method<Dim>& method,
                             const std::vector<int>& anchors, Scaling scaling, ConditionNorm norm) {
  Stencils stencils;
  for (int a : anchors) {
    stencils.push_back(scene.stencils.size() > 0 ? scene.stencils[a] : std::span<const int>{});
  }
  try {
    const std::vector<double> conditions =
        condition_by_part(method, scene.sites, anchors, stencils, scaling, norm);
    PerAnchor result{std::vector<double>(scene.sites.anchor_count(), none), ""};
    for (std::size_t i = 0; i < anchors.size(); ++i) result.values[anchors[i]] = conditions[i];
    return result;
  } catch (const CaseError& error) {
    return {{}, error.what()};
  } catch (const SkipCase& error) {
    return {{}, error.what()};
  }
}

template <int Dim>
PerAnchor lebesgue_numbers(const Discretisation<Dim>& scene, int order) {
  std::vector<int> slots;
  for (int d = 0; d < scene.derivatives.size(); ++d) {
    if (order_of<Dim>(scene.derivatives[d]) == order) slots.push_back(d);
  }
  if (slots.empty()) return {{}, fmt::format("the method gives no derivative of order {}", order)};
  const double scale = std::pow(scene.cloud.spacing(), order);
  return at_points(scene, [&](int p) {
    double largest = 0;
    for (int d : slots) {
      largest = std::max(largest, scale * scene.weights.row(p).row(d).cwiseAbs().sum());
    }
    return largest;
  });
}

template <int Dim>
PerAnchor laplacian_centres(const Discretisation<Dim>& scene) {
  std::vector<int> slots;
  for (int c = 0; c < Dim; ++c) {
    MultiIndex<Dim> twice{};
    twice[c] = 2;
    if (!scene.derivatives.contains(twice)) return {{}, "the method does not give the Laplacian"};
    slots.push_back(scene.derivatives.index(twice));
  }
  return at_points(scene, [&](int p) {
    const std::span<const int> nodes = scene.weights.nodes(p);
    const int own = scene.sites.anchor_node[scene.sites.point_anchor[p]];
    const auto place = std::find(nodes.begin(), nodes.end(), own) - nodes.begin();
    if (place == static_cast<std::ptrdiff_t>(nodes.size())) return 0.0;
    Eigen::RowVectorXd laplacian =
        Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(nodes.size()));
    for (int d : slots) laplacian += scene.weights.row(p).row(d);
    const double total = laplacian.cwiseAbs().sum();
    return total > 0 ? laplacian[place] / total : 0.0;
  });
}

template <int Dim>
PerAnchor reproduction_residuals(const Discretisation<Dim>& scene, int degree) {
  if (degree < 0) return {{}, "the method promises to reproduce no polynomial"};
  const auto monomials = Derivatives<Dim>::between_orders(0, degree);
  return at_points(scene, [&](int p) {
    const ScaledRow<Dim> scaled(scene, p);
    const Eigen::MatrixXd values = monomials_at<Dim>(scaled.z, monomials);
    double worst = 0;
    for (int d = 0; d < scene.derivatives.size(); ++d) {
      const MultiIndex<Dim>& alpha = scene.derivatives[d];
      const Eigen::VectorXd weights =
          scene.weights.row(p).row(d) * std::pow(scaled.radius, order_of<Dim>(alpha));
      const double total = weights.cwiseAbs().sum();
      const Eigen::VectorXd computed = values * weights;
      for (int a = 0; a < monomials.size(); ++a) {
        const double exact = monomials[a] == alpha ? factorial<Dim>(alpha) : 0;
        const double scale = std::max(total, exact);
        if (scale > 0) worst = std::max(worst, std::abs(computed[a] - exact) / scale);
      }
    }
    return worst;
  });
}

std::optional<ConditionLimit> condition_limit(const std::string& stencil, Zone zone) {
  const Spec spec = parse_spec(stencil);
  if (spec.name != "grow_until" && spec.name != "zoned") return std::nullopt;
  const Options options(find_entry(rules(), "stencil rule", spec.name).info, spec);
  if (spec.name == "zoned") {
    return condition_limit(options.text(zone == Zone::interior ? "interior" : "boundary"), zone);
  }
  return ConditionLimit{
      options.number("cond_max", 1, 1e300),
      options.choice<Scaling>("scaling", {{"both", Scaling::both}, {"row", Scaling::row}}),
      options.choice<ConditionNorm>("norm",
                                    {{"two", ConditionNorm::two}, {"one", ConditionNorm::one}})};
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same list for each dimension */                    \
  template PerAnchor stencil_sizes<Dim>(const Discretisation<Dim>&, const Method<Dim>&);       \
  template PerAnchor stencil_conditions<Dim>(const Discretisation<Dim>&, const Method<Dim>&,   \
                                             Scaling, ConditionNorm);                          \
  template PerAnchor stencil_conditions<Dim>(const Discretisation<Dim>&, const Method<Dim>&,   \
                                             const std::vector<int>&, Scaling, ConditionNorm); \
  template PerAnchor lebesgue_numbers<Dim>(const Discretisation<Dim>&, int);                   \
  template PerAnchor laplacian_centres<Dim>(const Discretisation<Dim>&);                       \
  template PerAnchor reproduction_residuals<Dim>(const Discretisation<Dim>&, int)
STRONGPOINT_INSTANTIATE(1);
STRONGPOINT_INSTANTIATE(2);
STRONGPOINT_INSTANTIATE(3);
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
