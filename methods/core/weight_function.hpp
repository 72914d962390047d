#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "methods/core/options.hpp"
#include "methods/core/simd/weight_formula.hpp"

namespace strongpoint {

/// Weight T on the residual of a least-squares fit; the square T^2 enters the normal equations.
class WeightFunction {
 public:
  WeightFunction() = default;
  WeightFunction(const WeightFunction&) = delete;
  WeightFunction& operator=(const WeightFunction&) = delete;
  virtual ~WeightFunction() = default;

  /// True when the weight is the cell measure of a node instead of a function of its distance.
  virtual bool uses_volumes() const { return false; }
  /// True when T is 1 at every distance: it need not be asked for.
  virtual bool is_one() const { return false; }
  /// The weight as kernels evaluate it themselves; null where they have to ask for `squared`.
  virtual const WeightFormula* formula() const { return nullptr; }
  /// T^2 at the distances `rho` = r / R, in [0, 1], R being the stencil's largest distance; it may
  /// be infinite at 0. Called once per stencil or group of stencils; never called for a weight that
  /// uses volumes.
  virtual void squared(std::span<const double> rho, std::span<double> result) const = 0;
};

/// A registered weight function.
struct WeightEntry {
  EntryInfo info;
  std::shared_ptr<const WeightFunction> (*make)(const Options& options);
};

/// A weight that kernels evaluate for many nodes at a time.
std::shared_ptr<const WeightFunction> weight_of_formula(const WeightFormula& formula);

/// Wraps `double f(double rho)`, which gives T^2, into a WeightFunction with a static loop: for
/// what no formula gives.
template <class Function>
std::shared_ptr<const WeightFunction> weight_of_distance(Function function) {
  class Wrapped final : public WeightFunction {
   public:
    explicit Wrapped(Function f) : function_(f) {}
    void squared(std::span<const double> rho, std::span<double> result) const override {
      for (std::size_t i = 0; i < rho.size(); ++i) result[i] = function_(rho[i]);
    }

   private:
    Function function_;
  };
  return std::make_shared<Wrapped>(function);
}

/// The support of the bell-shaped weights in units of the stencil's largest distance: a weight that
/// vanished at the farthest node would make a 3x3 stencil singular.
inline constexpr double weight_support = 1.1;

}  // namespace strongpoint
