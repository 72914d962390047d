#include <numbers>

#include "problems/core/flux_problem.hpp"
#include "problems/core/norms.hpp"
#include "problems/core/transient_problem.hpp"
#include "problems/core/wave_bar.hpp"

namespace strongpoint {
namespace {

using Point1 = Point<1>;

constexpr int left = 0;
constexpr MultiIndex<1> value{0}, first{1}, second{2};

/// u'' = inertia times the acceleration, u(0) = 0, u'(1) = F.
class BarEquations final : public FluxProblem<1> {
 public:
  explicit BarEquations(double force) : force_(force) {}

  const Domain<1>& domain() const override { return domain_; }
  std::vector<std::string> fields() const override { return {"u"}; }
  Derivatives<1> derivatives(std::span<const BoundaryMark<1>> marks) const override {
    if (marks.empty()) return {second};
    return marks[0].side == left ? Derivatives<1>{} : Derivatives<1>{first};
  }
  /// The force is what figures show.
  Derivatives<1> measured_derivatives() const override { return {first}; }
  void governing(const Place<1>& place, EquationWriter<1>& write) const override {
    write.add(0, second, 1);
    write.equals(0, inertia(0, place));
  }
  void boundary(const Node<1>& node, EquationWriter<1>& write) const override {
    write.add(0, node.on(left) ? value : first, 1);
    write.equals(node.on(left) ? 0 : force_);
  }
  void flux(int, const Place<1>&, const Point1& direction,
            EquationWriter<1>& write) const override {
    write.add(0, first, direction[0]);
  }
  double source(int, const Place<1>&) const override { return 0; }
  double inertia(int, const Place<1>&) const override { return 1; }
  Known known(int, int side) const override { return side == left ? Known::value : Known::flux; }
  double given(int, int side, const Point1&) const override { return side == left ? 0 : force_; }
  std::vector<std::string> quantities() const override { return {}; }
  std::vector<double> measure(const Solution<1>&) const override { return {}; }

 private:
  double force_;
  UnitCube<1> domain_;
};

class Bar1d final : public EigenProblem<1> {
 public:
  explicit Bar1d(double b) : pulse_{-100, b, 0.5}, space_(pulse_.force) {}

  const SteadyProblem<1>& space() const override { return space_; }
  double load(double time) const override { return pulse_.shape(time); }
  double wave_speed() const override { return 1; }
  double end_time() const override { return 3; }
  double time_step() const override { return 1e-4; }
  std::vector<std::string> quantities() const override { return {"u_error"}; }
  std::vector<double> measure(const Solution<1>& solution, double time) const override {
    return {relative_error(solution.fields.row(0).transpose(),
                           exact(solution.cloud, time).row(0).transpose())};
  }
  std::vector<NodeArray> derived_fields(const Solution<1>& solution, double time) const override {
    const Eigen::MatrixXd known = exact(solution.cloud, time);
    const Eigen::MatrixXd force = solution.derivative(0, first).transpose();
    return {{"u_exact", known.row(0)},
            error_array("u", solution.fields, known.row(0)),
            {"force", force},
            {"force_exact", known.row(1)}};
  }
  double frequency(int n) const override { return (2 * n - 1) * std::numbers::pi / 2; }
  Eigen::VectorXd mode(int n, const Point1& x) const override {
    return Eigen::VectorXd::Constant(1, std::sin(frequency(n) * x[0]));
  }

 private:
  BarPulse pulse_;
  BarEquations space_;

  /// (2, N) displacement and force.
  Eigen::MatrixXd exact(const PointCloud<1>& cloud, double time) const {
    Eigen::MatrixXd known(2, cloud.size());
    for (int i = 0; i < cloud.size(); ++i) {
      const double x = cloud.nodes(0, i);
      known.col(i) << pulse_.displacement(x, time), pulse_.section_force(x, time);
    }
    return known;
  }
};

}  // namespace

/// A bar clamped at x = 0 with a pulse of force -100 exp(-b (t - 0.5)^2) at x = 1; the speed of
/// waves, EA and the length are 1. `u_error` is the relative 2-norm over all nodes. Its modes are
/// sin(omega_n x), omega_n = (2n - 1) pi / 2. Source: thesis (4.23), (4.33), (4.40).
ProblemEntry problem_bar_1d() {
  return {{"bar_1d",
           "waves in a clamped bar under a pulse of force at its end",
           {{"b", "100", "sharpness of the pulse in time, 1 to 1e6"}}},
          [](const Options& options) -> AnyProblem {
            return std::make_unique<Bar1d>(options.number("b", 1, 1e6));
          }};
}

}  // namespace strongpoint
