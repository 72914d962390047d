#include <cmath>
#include <numbers>

#include "problems/core/flux_problem.hpp"
#include "problems/core/jet.hpp"
#include "problems/core/norms.hpp"

namespace strongpoint {
namespace {

using Point1 = Point<1>;

/// [0,1] with nodes at equidistant parameters to the power alpha. Source: thesis (2.18).
class PowerInterval final : public UnitCube<1> {
 public:
  explicit PowerInterval(double alpha) : alpha_(alpha) {}
  Point1 map(const Point1& unit) const override { return Point1(std::pow(unit[0], alpha_)); }

 private:
  double alpha_;
};

struct Exact {
  template <class T>
  T operator()(const std::array<T, 1>& x) const {
    return -1.0 * exp(x[0]) + std::numbers::e * x[0] + 1.0;
  }
};

class Bvp1d final : public FluxProblem<1> {
 public:
  explicit Bvp1d(double alpha) : domain_(alpha) {}

  const Domain<1>& domain() const override { return domain_; }
  std::vector<std::string> fields() const override { return {"u"}; }
  Derivatives<1> derivatives(std::span<const BoundaryMark<1>> marks) const override {
    if (marks.empty()) return {second};
    return marks[0].side == left ? Derivatives<1>{} : Derivatives<1>{first};
  }
  void governing(const Place<1>& place, EquationWriter<1>& write) const override {
    write_derivative(second, place.x, write);
  }
  void boundary(const Node<1>& node, EquationWriter<1>& write) const override {
    write_derivative(node.on(left) ? value : first, node.x, write);
  }
  void flux(int, const Place<1>&, const Point1& direction,
            EquationWriter<1>& write) const override {
    write.add(0, first, direction[0]);
  }
  double source(int, const Place<1>& place) const override { return exact_at(second, place.x); }
  Known known(int, int side) const override { return side == left ? Known::value : Known::flux; }
  double given(int, int side, const Point1& x) const override {
    return exact_at(side == left ? value : first, x);
  }
  std::vector<std::string> quantities() const override { return {"u_error", "u_max_error"}; }
  std::vector<double> measure(const Solution<1>& solution) const override {
    const Eigen::VectorXd exact = exact_at(solution.cloud.nodes);
    const Eigen::VectorXd computed = solution.fields.row(0);
    return {relative_error(computed, exact), relative_max_error(computed, exact)};
  }
  std::vector<NodeArray> derived_fields(const Solution<1>& solution) const override {
    return {error_array("u", solution.fields, exact_at(solution.cloud.nodes).transpose())};
  }

 private:
  static constexpr int left = 0;
  static constexpr MultiIndex<1> value{0}, first{1}, second{2};
  PowerInterval domain_;

  static double exact_at(const MultiIndex<1>& alpha, const Point1& x) {
    return exact_derivatives<1>(Exact{}, x, {alpha})[0];
  }
  static void write_derivative(const MultiIndex<1>& alpha, const Point1& x,
                               EquationWriter<1>& write) {
    write.add(0, alpha, 1);
    write.equals(exact_at(alpha, x));
  }
  /// (N) exact values.
  static Eigen::VectorXd exact_at(const Points<1>& nodes) {
    Eigen::VectorXd exact(nodes.cols());
    for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
      exact[i] = exact_derivatives<1>(Exact{}, nodes.col(i), {value})[0];
    }
    return exact;
  }
};

}  // namespace

/// u'' = -exp(x), u(0) = 0, u'(1) = 0. Source: thesis (2.17), (2.18).
ProblemEntry problem_bvp_1d() {
  return {{"bvp_1d",
           "two-point boundary value problem u'' = -exp(x), u(0) = 0, u'(1) = 0",
           {{"alpha", "1", "nodes lie at ((i-1)/(N-1))^alpha, 0.1 to 10"}}},
          [](const Options& options) -> AnyProblem {
            return std::make_unique<Bvp1d>(options.number("alpha", 0.1, 10));
          }};
}

}  // namespace strongpoint
