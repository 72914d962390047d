// Methods that theory says are the same give the same weights on the same stencils.
#include <gtest/gtest.h>

#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

/// Largest difference of the weights of two methods on the stencils of a scene, each derivative
/// relative to its largest weight.
template <int Dim>
double largest_difference(const TestScene<Dim>& scene, const std::string& a, const std::string& b,
                          const Derivatives<Dim>& derivatives) {
  const Weights first = make_method<Dim>(a).made->weights(scene.sites, scene.stencils, derivatives);
  const Weights second =
      make_method<Dim>(b).made->weights(scene.sites, scene.stencils, derivatives);
  double worst = 0;
  for (int p = 0; p < first.size(); ++p) {
    for (int d = 0; d < derivatives.size() && !first.nodes(p).empty(); ++d) {
      const Eigen::RowVectorXd row = first.row(p).row(d);
      worst = std::max(
          worst, (row - second.row(p).row(d)).cwiseAbs().maxCoeff() / row.cwiseAbs().maxCoeff());
    }
  }
  return worst;
}

template <int Dim>
void check_taylor_family(int order) {
  const std::string option = "order=" + std::to_string(order);
  const Derivatives<Dim> derivatives = Derivatives<Dim>::between_orders(1, order);
  for (const char* cloud : {"grid", "perturbed", "perturbed[amount=0.4]"}) {
    TestScene<Dim> scene =
        make_scene<Dim>("mfpm[" + option + "]", cloud, test_level<Dim>(order), 3);
    EXPECT_LT(largest_difference<Dim>(scene, "mfpm[" + option + "]",
                                      "gfdm[weight=one," + option + "]", derivatives),
              1e-12)
        << "gfdm, order " << order << " in " << Dim << "D on " << cloud;
    scene.sites.volumes = Eigen::VectorXd::Constant(scene.sites.node_count(), 0.3);
    // The same weight on every residual: it cancels but for round-off, times the condition (1e3).
    EXPECT_LT(largest_difference<Dim>(scene, "mfpm[" + option + "]",
                                      "mfpm_original[" + option + "]", derivatives),
              1e-12)
        << "mfpm_original, order " << order << " in " << Dim << "D on " << cloud;
  }
}

TEST(Identities, UnweightedGfdmAndOriginalMfpmOnEqualVolumesAreNovelMfpm) {
  for (int order : {1, 2, 3}) {
    check_taylor_family<1>(order);
    check_taylor_family<2>(order);
  }
  check_taylor_family<3>(1);
  check_taylor_family<3>(2);
}

}  // namespace
}  // namespace strongpoint
