#include "problems/core/jet.hpp"
#include "problems/core/problem.hpp"

namespace strongpoint {
namespace {

enum class Function { trig, franke, exponential, cubic, runge };

/// sin(2x+1) cos(3y) sin(z+1), the first factors in fewer dimensions.
struct Trig {
  template <class T, std::size_t Dim>
  T operator()(const std::array<T, Dim>& x) const {
    T result = sin(2.0 * x[0] + 1.0);
    if constexpr (Dim > 1) result = result * cos(3.0 * x[1]);
    if constexpr (Dim > 2) result = result * sin(x[2] + 1.0);
    return result;
  }
};

/// Franke's function; Renka's in 3D; its y = const terms dropped in 1D. Source: Franke 1979, Renka
/// 1988.
struct Franke {
  template <class T, std::size_t Dim>
  T operator()(const std::array<T, Dim>& x) const {
    const auto square = [](const T& t) { return t * t; };
    T first = -0.25 * square(9.0 * x[0] - 2.0);
    T second = -1.0 / 49 * square(9.0 * x[0] + 1.0);
    T third = -0.25 * square(9.0 * x[0] - 7.0);
    T fourth = -1.0 * square(9.0 * x[0] - 4.0);
    if constexpr (Dim > 1) {
      first = first - 0.25 * square(9.0 * x[1] - 2.0);
      second = second - 0.1 * (9.0 * x[1] + 1.0);
      third = third - 0.25 * square(9.0 * x[1] - 3.0);
      fourth = fourth - square(9.0 * x[1] - 7.0);
    }
    if constexpr (Dim > 2) {
      first = first - 0.25 * square(9.0 * x[2] - 2.0);
      second = second - 0.1 * (9.0 * x[2] + 1.0);
      third = third - 0.25 * square(9.0 * x[2] - 5.0);
      fourth = fourth - square(9.0 * x[2] - 5.0);
    }
    return 0.75 * exp(first) + 0.75 * exp(second) + 0.5 * exp(third) - 0.2 * exp(fourth);
  }
};

/// exp(x) sin(2y) cos(z), the first factors in fewer dimensions.
struct Exponential {
  template <class T, std::size_t Dim>
  T operator()(const std::array<T, Dim>& x) const {
    T result = exp(x[0]);
    if constexpr (Dim > 1) result = result * sin(2.0 * x[1]);
    if constexpr (Dim > 2) result = result * cos(x[2]);
    return result;
  }
};

/// (s + 1)^3 + s^2 x with s = x + 2y - z: every derivative up to the third is there.
struct Cubic {
  template <class T, std::size_t Dim>
  T operator()(const std::array<T, Dim>& x) const {
    T s = x[0];
    if constexpr (Dim > 1) s = s + 2.0 * x[1];
    if constexpr (Dim > 2) s = s - x[2];
    return (s + 1.0) * (s + 1.0) * (s + 1.0) + s * s * x[0];
  }
};

/// 1 / (1 + 25 |x - 1/2|^2).
struct Runge {
  template <class T, std::size_t Dim>
  T operator()(const std::array<T, Dim>& x) const {
    T sum = 1.0 + 25.0 * (x[0] - 0.5) * (x[0] - 0.5);
    for (std::size_t c = 1; c < Dim; ++c) sum = sum + 25.0 * (x[c] - 0.5) * (x[c] - 0.5);
    return 1.0 / sum;
  }
};

template <int Dim>
class Field final : public FieldProblem<Dim> {
 public:
  Field(Function function, int order)
      : function_(function), derivatives_(Derivatives<Dim>::between_orders(1, order)) {}

  const Domain<Dim>& domain() const override { return domain_; }
  Derivatives<Dim> derivatives() const override { return derivatives_; }
  Eigen::VectorXd exact(const Point<Dim>& x, const Derivatives<Dim>& wanted) const override {
    switch (function_) {
      case Function::trig:
        return exact_derivatives<Dim>(Trig{}, x, wanted);
      case Function::franke:
        return exact_derivatives<Dim>(Franke{}, x, wanted);
      case Function::exponential:
        return exact_derivatives<Dim>(Exponential{}, x, wanted);
      case Function::cubic:
        return exact_derivatives<Dim>(Cubic{}, x, wanted);
      case Function::runge:
        break;
    }
    return exact_derivatives<Dim>(Runge{}, x, wanted);
  }

 private:
  Function function_;
  Derivatives<Dim> derivatives_;
  UnitCube<Dim> domain_;
};

}  // namespace

/// Named smooth functions on the unit interval, square and cube, for judging derivative weights.
/// Source: Franke 1979, Renka 1988, Runge 1901; the others are plain.
ProblemEntry problem_field() {
  return {{"field",
           "a smooth function whose derivatives are approximated, nothing is solved",
           {{"name", "trig", "trig | franke | exponential | cubic | runge"},
            {"dim", "2", "space dimension, 1 to 3"},
            {"order", "2", "derivatives of order 1 to this are judged, 1 to 8"}}},
          [](const Options& options) -> AnyProblem {
            const Function function =
                options.choice<Function>("name", {{"trig", Function::trig},
                                                  {"franke", Function::franke},
                                                  {"exponential", Function::exponential},
                                                  {"cubic", Function::cubic},
                                                  {"runge", Function::runge}});
            const int order = options.integer("order", 1, 8);
            switch (options.integer("dim", 1, 3)) {
              case 1:
                return std::make_unique<Field<1>>(function, order);
              case 2:
                return std::make_unique<Field<2>>(function, order);
              default:
                return std::make_unique<Field<3>>(function, order);
            }
          }};
}

}  // namespace strongpoint
