#include <array>

#include <fmt/format.h>

#include "problems/core/elastic_problem.hpp"

namespace strongpoint {
namespace {

using Point2 = Point<2>;

enum class Strategy { patch, variable };
enum Side { left, right, bottom, top };

/// [first, last] x [0, 1] with sides of its own; some may be interfaces.
class Strip : public Domain<2> {
 public:
  /// `sides` are those on x = first, x = last, y = 0 and y = 1.
  Strip(double first, double last, std::array<int, 4> sides)
      : first_(first), last_(last), sides_(sides) {}

  const std::vector<std::string>& sides() const override {
    static const std::vector<std::string> names{"left", "right", "bottom", "top"};
    return names;
  }
  double measure() const override { return last_ - first_; }
  double reference_length() const override { return 1; }
  Point2 map(const Point2& unit) const override {
    return {(1 - unit[0]) * first_ + unit[0] * last_, unit[1]};
  }
  std::vector<int> sides_at(const Point2& unit) const override {
    std::vector<int> found;
    for (int face = 0; face < 4; ++face) {
      if (unit[face / 2] == face % 2) found.push_back(sides_[face]);
    }
    return found;
  }
  Point2 normal(int side, const Point2& x) const override {
    const bool is_along_x = side == interface_side || side < bottom;
    if (is_along_x) return {x[0] < (first_ + last_) / 2 ? -1 : 1, 0};
    return {0, side == bottom ? -1 : 1};
  }
  double distance(const Point2& x) const override {
    const Point2 beyond(std::max(first_ - x[0], x[0] - last_), std::max(-x[1], x[1] - 1));
    return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
  }
  std::vector<BoundaryPiece<2>> pieces() const override {
    std::vector<BoundaryPiece<2>> all;
    all.reserve(4);
    for (int face = 0; face < 4; ++face) {
      all.push_back({sides_[face], [this, face](const BoundaryPiece<2>::Parameter& t) {
                       Point2 unit;
                       unit[face / 2] = face % 2;
                       unit[1 - face / 2] = t[0];
                       return map(unit);
                     }});
    }
    return all;
  }

 private:
  double first_, last_;
  std::array<int, 4> sides_;
};

/// Two strips that meet at x = 1, or one whole.
class TwoStrips final : public Strip {
 public:
  explicit TwoStrips(Strategy strategy)
      : Strip(0, 2, {left, right, bottom, top}), strategy_(strategy) {}
  std::vector<const Domain<2>*> patches() const override {
    if (strategy_ == Strategy::variable) return {};
    return {&first_, &second_};
  }

 private:
  Strategy strategy_;
  Strip first_{0, 1, {left, interface_side, bottom, top}};
  Strip second_{1, 2, {interface_side, right, bottom, top}};
};

struct Material {
  double young, poisson;

  /// Strains along and across a unit tension in plane strain.
  double along() const { return (1 - poisson * poisson) / young; }
  double across() const { return -poisson * (1 + poisson) / young; }
};

/// The strains across the tension are the same, so that the solution is piecewise linear.
constexpr std::array<Material, 2> materials{{{100, 0.2}, {700.0 / 3, 0.4}}};

class TwoMaterials final : public ElasticProblem<2> {
 public:
  TwoMaterials(Strategy strategy, Unknowns unknowns)
      : ElasticProblem(unknowns), strategy_(strategy), domain_(strategy) {}

  const Domain<2>& domain() const override { return domain_; }
  Lame material(const Place<2>& place) const override {
    if (strategy_ == Strategy::patch) return lame_[place.patch];
    return at(place.x[0]);
  }
  bool varies() const override { return strategy_ == Strategy::variable; }
  bool has_even_flux() const override { return strategy_ == Strategy::patch; }
  LameGradient<2> material_gradient(const Place<2>& place) const override {
    const double step = place.spacing;
    const Lame before = at(place.x[0] - step);
    const Lame after = at(place.x[0] + step);
    return {{(after.lambda - before.lambda) / (2 * step), 0},
            {(after.mu - before.mu) / (2 * step), 0}};
  }
  std::vector<SymmetryPlane> symmetry_planes() const override {
    return {{left, 0, 0}, {bottom, 1, 0}};
  }
  Derivatives<2> measured_derivatives() const override { return first_derivatives(); }
  Known known(int field, int side) const override {
    const int suppressed = side == left ? 0 : side == bottom ? 1 : -1;
    return field == suppressed ? Known::value : Known::flux;
  }
  double given(int field, int side, const Point2&) const override {
    return side == right && field == 0 ? 1 : 0;
  }

  std::vector<std::string> quantities() const override {
    return {"displacement_error", "stress_error"};
  }
  std::vector<double> measure(const Solution<2>& solution) const override {
    return errors_at_nodes(solution);
  }

 protected:
  std::optional<ElasticNodes> exact_at_nodes(const PointCloud<2>& cloud) const override {
    ElasticNodes exact{Eigen::MatrixXd(2, cloud.size()), Eigen::MatrixXd::Zero(3, cloud.size())};
    for (int i = 0; i < cloud.size(); ++i) {
      const Point2 x = cloud.nodes.col(i);
      exact.fields.col(i) << materials[0].along() * std::min(x[0], 1.0) +
                                 materials[1].along() * std::max(x[0] - 1, 0.0),
          materials[0].across() * x[1];
      exact.stresses(0, i) = 1;
    }
    return exact;
  }

 private:
  Strategy strategy_;
  TwoStrips domain_;
  std::array<Lame, 2> lame_{lame_constants(materials[0].young, materials[0].poisson),
                            lame_constants(materials[1].young, materials[1].poisson)};

  /// The material at an abscissa; the mean where both meet.
  Lame at(double x) const {
    if (x != 1) return lame_[x < 1 ? 0 : 1];
    return {(lame_[0].lambda + lame_[1].lambda) / 2, (lame_[0].mu + lame_[1].mu) / 2};
  }
};

}  // namespace

/// Two squares of different materials side by side under tension: as two patches joined by
/// conditions on their interface, or as one with varying coefficients, (4.21), whose gradients at
/// the jump are differences over one spacing to either side. The latter is wrong by a quarter on
/// grids however fine, and by more on scattered nodes: the thesis warns of oscillations. Source:
/// thesis 4.2.3; its sizes and constants are ours.
ProblemEntry problem_two_materials() {
  return {{"two_materials",
           "two materials under tension, plane strain, piecewise linear solution",
           {{"strategy", "patch",
             "patch | variable: patches joined along their interface, or varying coefficients"},
            unknowns_option()}},
          [](const Options& options) -> AnyProblem {
            return std::make_unique<TwoMaterials>(
                options.choice<Strategy>(
                    "strategy", {{"patch", Strategy::patch}, {"variable", Strategy::variable}}),
                chosen_unknowns(options));
          }};
}

}  // namespace strongpoint
