#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/local_method.hpp"
#include "tests/contract_support.hpp"
#include "tests/simd_paths.hpp"

// Checks of kernels that treat stencils side by side, against the same kernel one by one.

namespace strongpoint {

/// Sites with two more evaluation points at every third anchor, off the anchor.
template <int Dim>
Sites<Dim> with_points_between(Sites<Dim> sites, double spacing) {
  const int count = sites.anchor_count();
  const int extra = (count + 2) / 3;
  sites.points.conservativeResize(Dim, count + 2 * extra);
  for (int i = 0; i < 2 * extra; ++i) {
    const int anchor = i / 2 * 3;
    sites.points.col(count + i) =
        sites.anchors.col(anchor) + Point<Dim>::Constant((i % 2 == 0 ? 0.1 : -0.2) * spacing);
    sites.point_anchor.push_back(anchor);
  }
  return sites;
}

/// The kernel of a scene's method.
template <class Kernel, int Dim>
const Kernel& kernel_of(const TestScene<Dim>& scene) {
  return dynamic_cast<const LocalMethod<Dim, Kernel>&>(*scene.method).kernel();
}

/// Weights of all points, one anchor after the other, without a batch.
template <int Dim, class Kernel>
Weights weights_one_by_one(const Kernel& kernel, const Sites<Dim>& sites, const Stencils& stencils,
                           const Derivatives<Dim>& derivatives) {
  Weights weights = weights_on_stencils<Dim>(sites, stencils, derivatives.size());
  LocalStencil<Dim> local;
  typename Kernel::Workspace work;
  for (int p = 0; p < sites.point_count(); ++p) {
    const int anchor = sites.point_anchor[p];
    if (stencils[anchor].empty()) continue;
    EXPECT_EQ(local.gather(sites, stencils[anchor], anchor), LocalOutcome::ok);
    EXPECT_EQ(kernel.factorise(local, work), LocalOutcome::ok);
    Eigen::Map<Eigen::MatrixXd> row = weights.row(p);
    const Point<Dim> offset = (sites.points.col(p) - sites.anchors.col(anchor)) / local.radius;
    kernel.evaluate(local, work, offset, derivatives, row);
    for (int d = 0; d < derivatives.size(); ++d) {
      row.row(d) *= std::pow(local.radius, -order_of<Dim>(derivatives[d]));
    }
  }
  return weights;
}

/// What a batch gives alone: weights, and outcomes of the anchors with a stencil.
struct BatchResult {
  Weights weights;
  std::vector<int> anchors;
  std::vector<LocalOutcome> outcomes;

  double share_served() const {
    const auto served = std::count(outcomes.begin(), outcomes.end(), LocalOutcome::ok);
    return static_cast<double>(served) / static_cast<double>(outcomes.size());
  }
};

/// Fills the weights of all anchors by batches of so many.
template <int Dim, class Kernel>
BatchResult fill_batches(const Kernel& kernel, const Sites<Dim>& sites, const Stencils& stencils,
                         const Derivatives<Dim>& derivatives, std::size_t size) {
  BatchResult made;
  made.weights = weights_on_stencils<Dim>(sites, stencils, derivatives.size());
  made.anchors = stencils.occupied();
  made.outcomes.assign(made.anchors.size(), LocalOutcome::undecided);
  const Stencils points = points_by_anchor<Dim>(sites);
  typename Kernel::Workspace work;
  for (std::size_t begin = 0; begin < made.anchors.size(); begin += size) {
    const std::size_t count = std::min(size, made.anchors.size() - begin);
    kernel.fill_batch({sites, stencils, points, derivatives, {made.anchors.data() + begin, count}},
                      work, made.weights, {made.outcomes.data() + begin, count});
  }
  return made;
}

/// Weights of a batch against others, over the points of the anchors it serves: the largest
/// difference, relative to the largest weight of the derivatives of one order.
template <int Dim>
double largest_difference(const BatchResult& found, const Weights& expected,
                          const Sites<Dim>& sites, const Derivatives<Dim>& derivatives) {
  std::vector<bool> is_served(sites.anchor_count());
  for (std::size_t i = 0; i < found.anchors.size(); ++i) {
    is_served[found.anchors[i]] = found.outcomes[i] == LocalOutcome::ok;
  }
  double worst = 0;
  for (int p = 0; p < expected.size(); ++p) {
    if (!is_served[sites.point_anchor[p]]) continue;
    const Eigen::ArrayXd difference =
        (found.weights.row(p) - expected.row(p)).cwiseAbs().rowwise().maxCoeff();
    const Eigen::ArrayXd size = expected.row(p).cwiseAbs().rowwise().maxCoeff();
    double largest = 0;
    for (int d = 0; d < derivatives.size(); ++d) {
      double scale = 0;
      for (int e = 0; e < derivatives.size(); ++e) {
        const bool is_alike = order_of<Dim>(derivatives[d]) == order_of<Dim>(derivatives[e]);
        if (is_alike) scale = std::max(scale, size[e]);
      }
      largest = difference[d] <= largest * scale ? largest : difference[d] / scale;
    }
    worst = largest <= worst ? worst : largest;  // what is not a number stays
  }
  return worst;
}

/// Every path against the kernel one by one, within a tolerance, at anchors and between:
/// derivatives of order `least` to 2. Most stencils must be served side by side.
template <int Dim, class Kernel>
void matches_one_by_one(const std::string& spec, const std::string& cloud, int least, int level,
                        double tolerance) {
  SCOPED_TRACE(fmt::format("{} {}D on {}", spec, Dim, cloud));
  const auto scene = make_scene<Dim>(spec, cloud, level, 1);
  const Kernel& kernel = kernel_of<Kernel, Dim>(scene);
  const Sites<Dim> sites = with_points_between<Dim>(scene.sites, 1.0 / level);
  const auto derivatives = Derivatives<Dim>::between_orders(least, 2);
  const Weights expected = weights_one_by_one<Dim>(kernel, sites, scene.stencils, derivatives);
  on_every_path([&] {
    const BatchResult found = fill_batches<Dim>(kernel, sites, scene.stencils, derivatives, 64);
    EXPECT_GE(found.share_served(), 0.8);
    EXPECT_LE(largest_difference<Dim>(found, expected, sites, derivatives), tolerance);
  });
}

/// Stencils whose nodes come nearer to an oblique line from left to right, up to `factor` times
/// their heights: some must be left to be treated one by one, the others keep their digits.
template <class Kernel>
void leaves_what_is_ill_conditioned(const std::string& spec, double factor, double tolerance) {
  SCOPED_TRACE(spec);
  const auto scene = make_scene<2>(spec, "perturbed[amount=0.2]", 16, 1);
  const Kernel& kernel = kernel_of<Kernel, 2>(scene);
  Sites<2> sites = scene.sites;
  for (Points<2>* places : {&sites.nodes, &sites.anchors, &sites.points}) {
    for (int i = 0; i < places->cols(); ++i) {
      (*places)(1, i) *= std::pow(factor, (*places)(0, i));
      (*places)(1, i) += 0.7 * (*places)(0, i);
    }
  }
  const auto derivatives = Derivatives<2>::between_orders(0, 2);
  const Weights expected = weights_one_by_one<2>(kernel, sites, scene.stencils, derivatives);
  on_every_path([&] {
    const BatchResult found = fill_batches<2>(kernel, sites, scene.stencils, derivatives, 64);
    EXPECT_GT(found.share_served(), 0.1);
    EXPECT_LT(found.share_served(), 1);
    EXPECT_LE(largest_difference<2>(found, expected, sites, derivatives), tolerance);
  });
}

/// What an anchor gets does not depend on the others, nor on threads.
template <int Dim, class Kernel>
void gives_same_bits_in_any_company(const std::string& spec) {
  SCOPED_TRACE(spec);
  const auto scene = make_scene<Dim>(spec, "perturbed[amount=0.3]", Dim == 2 ? 14 : 7, 1);
  const Kernel& kernel = kernel_of<Kernel, Dim>(scene);
  const auto derivatives = Derivatives<Dim>::between_orders(1, 2);
  const Sites<Dim> sites = with_points_between<Dim>(scene.sites, 0.1);
  on_every_path([&] {
    const BatchResult all = fill_batches<Dim>(kernel, sites, scene.stencils, derivatives, 64);
    for (const std::size_t size : {1, 3, 31}) {
      const BatchResult some = fill_batches<Dim>(kernel, sites, scene.stencils, derivatives, size);
      EXPECT_EQ(all.outcomes, some.outcomes);
      EXPECT_EQ(all.weights.values, some.weights.values) << size;
    }
    const int before = omp_get_max_threads();
    omp_set_num_threads(1);
    const Weights one = scene.method->weights(sites, scene.stencils, derivatives);
    omp_set_num_threads(3);
    const Weights three = scene.method->weights(sites, scene.stencils, derivatives);
    omp_set_num_threads(before);
    EXPECT_EQ(one.values, three.values);
  });
}

}  // namespace strongpoint
