#include "problems/core/elastic_fields.hpp"

#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "methods/core/neighbours.hpp"
#include "methods/core/registry.hpp"
#include "problems/core/elastic_problem.hpp"
#include "problems/core/layout.hpp"
#include "studies/support/run_case.hpp"

namespace strongpoint {
namespace {

/// Round-off of a handful of operations on numbers of order one.
constexpr double round_off = 1e-13;
/// The same of weights, which divide by spacings of a quarter and condition numbers of some tens.
constexpr double weights_round_off = 1e-11;

/// No stress across the plane follows from those in it.
constexpr Lame no_contraction{0, 1};

TEST(ElasticFields, VonMisesIsTheStressUnderTension) {
  EXPECT_NEAR(von_mises<3>({3, 0, 0, 0, 0, 0}, {1, 1}), 3, round_off);
  EXPECT_NEAR(von_mises<3>({0, -3, 0, 0, 0, 0}, {1, 1}), 3, round_off);
  EXPECT_NEAR(von_mises<2>({0, -3, 0}, no_contraction), 3, round_off);
}

TEST(ElasticFields, VonMisesIsRootThreeTimesAShear) {
  for (int c = 3; c < 6; ++c) {
    EXPECT_NEAR(von_mises<3>(2 * Eigen::Matrix<double, 6, 1>::Unit(c), {1, 1}), 2 * std::sqrt(3),
                round_off);
  }
  EXPECT_NEAR(von_mises<2>({0, 0, 2}, {1, 1}), 2 * std::sqrt(3), round_off);
}

TEST(ElasticFields, PressureHasNoVonMisesStress) {
  EXPECT_NEAR(von_mises<3>({-5, -5, -5, 0, 0, 0}, {1, 1}), 0, round_off);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(von_mises<2>({-5, -5, 0}, {infinity, 1}), 0, round_off);  // incompressible
}

TEST(ElasticFields, VonMisesIsThatOfThePrincipalStresses) {
  const Eigen::Matrix3d root = Eigen::Matrix3d::Random();
  const Eigen::Matrix3d s = root + root.transpose();
  const Eigen::Vector3d p = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(s).eigenvalues();
  const double expected = std::sqrt(
      (std::pow(p[0] - p[1], 2) + std::pow(p[1] - p[2], 2) + std::pow(p[2] - p[0], 2)) / 2);
  EXPECT_NEAR(von_mises<3>(tensor_components<3>(s), {1, 1}), expected, round_off);
}

TEST(ElasticFields, PlaneStrainIsABodyInSpaceWithoutStrainAcross) {
  const Lame material = lame_constants(7, 0.3);
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  gradient.topLeftCorner<2, 2>() = Eigen::Matrix2d::Random();
  const Eigen::Matrix3d whole = stress<3>(material, gradient);
  const Eigen::Matrix2d plane = whole.topLeftCorner<2, 2>();
  EXPECT_NEAR(von_mises<2>(tensor_components<2>(plane), material),
              von_mises<3>(tensor_components<3>(whole), material), round_off);
  EXPECT_NEAR(volumetric_share<2>(material), 0.3, round_off);
}

/// A unit cube under a displacement that is linear in x, half of which is claimed to be exact; the
/// material differs from node to node.
template <int Dim>
class LinearBody final : public ElasticProblem<Dim> {
 public:
  using Tensor = Eigen::Matrix<double, Dim, Dim>;
  using ElasticProblem<Dim>::ElasticProblem;

  const Domain<Dim>& domain() const override { return domain_; }
  Lame material(const Place<Dim>& place) const override {
    return {1 + place.x[0], 0.5 + place.x[1]};
  }
  Known known(int, int) const override { return Known::value; }
  double given(int, int, const Point<Dim>&) const override { return 0; }
  std::vector<std::string> quantities() const override { return {}; }
  std::vector<double> measure(const Solution<Dim>&) const override { return {}; }
  Derivatives<Dim> measured_derivatives() const override {
    return measures_ ? this->first_derivatives() : Derivatives<Dim>{};
  }

  static Tensor gradient() {
    Tensor all;
    for (int i = 0; i < Dim; ++i) {
      for (int j = 0; j < Dim; ++j) all(i, j) = std::sin(1.0 + i + 2.5 * j);
    }
    return all;
  }
  Tensor stress_at(const Point<Dim>& x) const { return stress<Dim>(material({x}), gradient()); }
  double pressure_at(const Point<Dim>& x) const {
    return -material({x}).lambda * gradient().trace();
  }
  void measure_nothing() { measures_ = false; }

  /// What it shows of the solution, by name.
  std::map<std::string, Eigen::MatrixXd> arrays(const PointCloud<Dim>& cloud) const {
    const auto method = make_method<Dim>("lsfdm").made;
    const auto rule = make_rule<Dim>(method->default_stencil()).made;
    const Sites<Dim> sites = sites_of_cloud<Dim>(cloud);
    const auto search = make_search<Dim>("auto", sites.nodes);
    const Derivatives<Dim> derivatives = this->first_derivatives();
    const Weights weights =
        method->weights(sites, select_stencils<Dim>(*rule, sites, *method, *search), derivatives);
    Eigen::MatrixXd fields(this->fields().size(), cloud.size());
    fields.topRows(Dim) = gradient() * cloud.nodes;
    if (this->is_mixed()) {
      for (int i = 0; i < cloud.size(); ++i) fields(Dim, i) = pressure_at(cloud.nodes.col(i));
    }
    std::map<std::string, Eigen::MatrixXd> named;
    for (const NodeArray& array :
         this->derived_fields({cloud, fields, fields, weights, derivatives})) {
      named[array.name] = array.values;
    }
    return named;
  }

 protected:
  std::optional<ElasticNodes> exact_at_nodes(const PointCloud<Dim>& cloud) const override {
    ElasticNodes half{gradient() * cloud.nodes / 2,
                      Eigen::MatrixXd(Dim * (Dim + 1) / 2, cloud.size())};
    for (int i = 0; i < cloud.size(); ++i) {
      half.stresses.col(i) = tensor_components<Dim>(stress_at(cloud.nodes.col(i))) / 2;
    }
    return half;
  }

 private:
  UnitCube<Dim> domain_;
  bool measures_ = true;
};

template <int Dim>
void expect_arrays(Unknowns unknowns, const std::vector<std::string>& names) {
  const LinearBody<Dim> body(unknowns);
  const PointCloud<Dim> cloud = make_cloud<Dim>(body.domain(), "perturbed", LayoutRequest{5, 1});
  const auto arrays = body.arrays(cloud);
  ASSERT_EQ(arrays.size(), 3 + 2 * names.size() + body.fields().size());
  for (int i = 0; i < cloud.size(); ++i) {
    const Point<Dim> x = cloud.nodes.col(i);
    const auto expected = tensor_components<Dim>(body.stress_at(x));
    for (std::size_t c = 0; c < names.size(); ++c) {
      EXPECT_NEAR(arrays.at(names[c])(0, i), expected[c], weights_round_off) << names[c];
      EXPECT_NEAR(arrays.at(names[c] + "_error")(0, i), std::abs(expected[c]) / 2,
                  weights_round_off);
    }
    const double equivalent = von_mises<Dim>(expected, body.material({x}));
    EXPECT_NEAR(arrays.at("von_mises")(0, i), equivalent, weights_round_off);
    EXPECT_NEAR(arrays.at("von_mises_error")(0, i), equivalent / 2, weights_round_off);
    const Point<Dim> u = body.gradient() * x;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(arrays.at("displacement")(c, i), c < Dim ? u[c] : 0, round_off);
    }
    EXPECT_NEAR(arrays.at("v_error")(0, i), std::abs(u[1]) / 2, round_off);
    if (body.is_mixed()) {
      EXPECT_NEAR(arrays.at("p_error")(0, i), std::abs(body.pressure_at(x)) / 2, round_off);
    }
  }
}

TEST(ElasticFields, AreThoseOfALinearDisplacementInAPlane) {
  for (const Unknowns unknowns : {Unknowns::displacement, Unknowns::mixed}) {
    expect_arrays<2>(unknowns, {"sigma_xx", "sigma_yy", "tau_xy"});
  }
}
TEST(ElasticFields, AreThoseOfALinearDisplacementInSpace) {
  for (const Unknowns unknowns : {Unknowns::displacement, Unknowns::mixed}) {
    expect_arrays<3>(unknowns, {"sigma_xx", "sigma_yy", "sigma_zz", "tau_xy", "tau_xz", "tau_yz"});
  }
}

TEST(ElasticFields, HaveNoStressesWhereNobodyMeasuresThem) {
  LinearBody<2> body;
  body.measure_nothing();
  const PointCloud<2> cloud = make_cloud<2>(body.domain(), "grid", LayoutRequest{5, 1});
  std::vector<std::string> names;
  for (const auto& [name, values] : body.arrays(cloud)) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{"displacement", "u_error", "v_error"}));
}

}  // namespace
}  // namespace strongpoint
