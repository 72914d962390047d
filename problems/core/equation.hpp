#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "methods/core/derivatives.hpp"

namespace strongpoint {

/// One summand of an equation: coefficient * derivative of a field at an evaluation point.
struct Term {
  int point;
  std::int16_t field;
  std::int16_t
      derivative;  ///< position in the derivatives asked for, `value_only` for the bare value
  double coefficient;
};

/// Marks a term on the value of a field at a node whose point has no weights.
inline constexpr std::int16_t value_only = -1;

/// The rows of a discrete system as data, in row order.
struct EquationList {
  std::vector<std::int64_t> offsets{0};  ///< (rows + 1) into `terms`
  std::vector<Term> terms;
  std::vector<double> right_hand_sides;  ///< (rows)
  std::vector<double> inertia;           ///< (rows) factors of second time derivatives
  std::vector<double> row_weights;       ///< (rows) factors of rows after scaling, empty for ones

  int size() const { return static_cast<int>(right_hand_sides.size()); }
  std::span<const Term> row(int i) const {
    return {terms.data() + offsets[i], terms.data() + offsets[i + 1]};
  }
  /// Empties the list and keeps its memory.
  void clear() {
    offsets.resize(1);
    terms.clear();
    right_hand_sides.clear();
    inertia.clear();
    row_weights.clear();
  }
};

/// Lets a problem state equations at one evaluation point.
template <int Dim>
class EquationWriter {
 public:
  /// Writes into `list`; derivatives are looked up in `derivatives`, which must outlive the writer.
  EquationWriter(EquationList& list, const Derivatives<Dim>& derivatives)
      : list_(list), derivatives_(derivatives) {}

  /// Sets the evaluation point of the equations that follow.
  void at(int point) { point_ = point; }
  /// Adds a term to the equation being written. Throws std::logic_error for an undeclared
  /// derivative.
  void add(int field, const MultiIndex<Dim>& alpha, double coefficient) {
    const bool is_value = order_of<Dim>(alpha) == 0 && !derivatives_.contains(alpha);
    const int slot = is_value ? value_only : derivatives_.index(alpha);
    list_.terms.push_back(
        {point_, static_cast<std::int16_t>(field), static_cast<std::int16_t>(slot), coefficient});
  }
  /// Adds a term on the unknown of a node of the sites, whatever its point's weights are.
  void add_unknown(int node, int field, double coefficient) {
    list_.terms.push_back({node, static_cast<std::int16_t>(field), value_only, coefficient});
  }
  /// Adds the terms of a row of another list, times a factor.
  void add_row(std::span<const Term> row, double factor = 1) {
    for (Term term : row) {
      term.coefficient *= factor;
      list_.terms.push_back(term);
    }
  }
  /// True when a row reads values alone.
  bool is_value(std::span<const Term> row) const {
    for (const Term& term : row) {
      if (term.derivative != value_only && order_of<Dim>(derivatives_[term.derivative]) > 0) {
        return false;
      }
    }
    return true;
  }
  /// Ends the equation: the sum of its terms equals `right_hand_side`, to which a problem in time
  /// adds `inertia` times the second time derivative of the value of the row's own field and node.
  void equals(double right_hand_side, double inertia = 0) {
    list_.right_hand_sides.push_back(right_hand_side);
    list_.inertia.push_back(inertia);
    list_.offsets.push_back(static_cast<std::int64_t>(list_.terms.size()));
  }

 private:
  EquationList& list_;
  const Derivatives<Dim>& derivatives_;
  int point_ = 0;
};

}  // namespace strongpoint
