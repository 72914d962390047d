// Goals of RBF-FD weights: r^3 with polynomials of degree 2 on 15 nodes and of degree 4 on 30, five
// derivatives, against Eigen's pivoted LU of the bordered matrix of each stencil.
#include <algorithm>
#include <memory>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <omp.h>

#include "bench/goal.hpp"
#include "bench/local_case.hpp"
#include "bench/rbf_rival.hpp"
#include "bench/report.hpp"
#include "methods/core/local_method.hpp"

namespace strongpoint {
namespace {

/// Nodes per side: about 1e5 in all.
constexpr int level = 317;

/// Sites and stencils of a perturbed grid, for RBF-FD.
LocalCase<2> make_case(int degree, int size) {
  LocalCase<2> made;
  made.method = make_method<2>(fmt::format("rbf_fd[degree={}]", degree)).made;
  const auto rule = make_rule<2>(fmt::format("nearest[k={},ties=cut]", size));
  made.stencil = rule.spec;
  made.cloud = make_cloud<2>(UnitCube<2>{}, bench_cloud, {.level = level});
  made.sites = sites_at_nodes<2>(made.cloud.nodes);
  const auto search = make_search<2>("auto", made.sites.nodes);
  made.stencils = select_stencils<2>(*rule.made, made.sites, *made.method, *search);
  return made;
}

/// The rival's weights.
Weights rival_weights(const LocalCase<2>& local, int degree, int size) {
  Weights weights = weights_on_stencils<2>(local.sites, local.stencils, 5);
  const RbfRivalTask task{size,
                          degree,
                          local.sites.node_count(),
                          local.sites.nodes.data(),
                          local.stencils.nodes.data(),
                          weights.values.data()};
  rbf_rival_weights(&task);
  return weights;
}

/// Throws unless the weights of every node and derivative agree, relative to their length.
void compare(const Weights& ours, const Weights& theirs) {
  constexpr double tolerance = 1e-9;  // round-off of bordered matrices of condition 1e5 or so
  for (int i = 0; i < ours.size(); ++i) {
    const Eigen::MatrixXd difference = ours.row(i) - theirs.row(i);
    for (int d = 0; d < ours.per_entry; ++d) {
      const double error = difference.row(d).norm() / theirs.row(i).row(d).norm();
      if (!(error <= tolerance)) {
        throw CaseError(
            fmt::format("weights of node {} differ from the rival's by {:.1e}", i, error));
      }
    }
  }
}

Contest contest(int degree, int size) {
  const auto local = std::make_shared<const LocalCase<2>>(make_case(degree, size));
  const auto derivatives = Derivatives<2>::between_orders(1, 2);
  const auto ours = [local, derivatives] {
    return local->method->weights(local->sites, local->stencils, derivatives);
  };
  const auto theirs = [local, degree, size] { return rival_weights(*local, degree, size); };
  compare(ours(), theirs());
  return {[ours] { benchmark::DoNotOptimize(ours().values.data()); },
          [theirs] { benchmark::DoNotOptimize(theirs().values.data()); },
          static_cast<double>(local->cloud.size()), local->label(), 5};
}

int run(int argc, char** argv) {
  bool failed = false;
  const std::string rival = "Eigen PartialPivLU per point";
  add_goal({"rbf_fd/r3/degree2/k15", rival, 5, 9}, failed, [] { return contest(2, 15); });
  add_goal({"rbf_fd/r3/degree4/k30", rival, 3, 6}, failed, [] { return contest(4, 30); });
  omp_set_num_threads(1);  // a node's cost, not the machine's width
  return run_registered(argc, argv, failed);
}

}  // namespace
}  // namespace strongpoint

int main(int argc, char** argv) { return strongpoint::run(argc, argv); }
