#pragma once

#include <array>
#include <cstdint>
#include <iterator>

#include "methods/core/derivatives.hpp"
#include "methods/core/large_array.hpp"

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

/// Where the terms of an equation lie in a list. Equations that differ in their point alone share
/// their terms.
struct EquationPlace {
  std::int64_t first;  ///< of the terms
  int count;           ///< number of terms
  int point;           ///< of all terms, `own_points` where each names its own
};

/// Marks an equation with terms at several points.
inline constexpr int own_points = -1;

/// The terms of an equation, to be looped over; each is handed out by value.
class EquationRow {
 public:
  /// Walks through terms and puts in their point.
  class Iterator {
   public:
    using value_type = Term;
    using difference_type = std::ptrdiff_t;
    using pointer = const Term*;
    using reference = Term;
    using iterator_category = std::input_iterator_tag;

    Iterator(const Term* term, int point) : term_(term), point_(point) {}
    Term operator*() const {
      Term term = *term_;
      if (point_ != own_points) term.point = point_;
      return term;
    }
    Iterator& operator++() {
      ++term_;
      return *this;
    }
    bool operator==(const Iterator& other) const { return term_ == other.term_; }

   private:
    const Term* term_;
    int point_;
  };

  EquationRow(const Term* terms, int count, int point)
      : terms_(terms), count_(count), point_(point) {}

  Iterator begin() const { return {terms_, point_}; }
  Iterator end() const { return {terms_ + count_, point_}; }
  int size() const { return count_; }
  bool empty() const { return count_ == 0; }
  Term front() const { return *begin(); }
  /// The point of all terms, `own_points` where they differ.
  int point() const { return point_; }

 private:
  const Term* terms_;
  int count_;
  int point_;
};

/// The rows of a discrete system as data, in row order. Rows at one point, the usual case, are kept
/// as their point and the terms, once for all that are alike.
struct EquationList {
  LargeArray<EquationPlace> places;     ///< (rows)
  LargeArray<Term> terms;               ///< points of shared ones mean nothing
  LargeArray<double> right_hand_sides;  ///< (rows)
  LargeArray<double> inertia;           ///< (rows) factors of second time derivatives, empty for
                                        ///< zeros
  LargeArray<double> row_weights;       ///< (rows) factors of rows after scaling, empty for ones

  int size() const { return static_cast<int>(right_hand_sides.size()); }
  EquationRow row(int i) const {
    const EquationPlace& place = places[i];
    return {terms.data() + place.first, place.count, place.point};
  }
  double inertia_of(int row) const { return inertia.empty() ? 0 : inertia[row]; }
  /// Ends the row whose terms are those beyond the rows before.
  void end_row(double right_hand_side, double inertia_factor);
  /// Empties the list and keeps its memory.
  void clear();
  /// Makes room for so many rows.
  void reserve(int rows);

 private:
  static constexpr int remembered = 8;

  std::int64_t begin_ = 0;                          ///< first term of the row being written
  std::array<EquationPlace, remembered> recent_{};  ///< rows with terms of their own
  int next_recent_ = 0;                             ///< the one that is replaced next
  int guess_ = 0;                                   ///< rows come in turns

  /// The row among the recent ones with the same terms as the one being written, else null.
  const EquationPlace* find_alike(int count);
  bool is_alike(const EquationPlace& place, int count) const;
};

/// Lets a problem state equations at one evaluation point.
template <int Dim>
class EquationWriter {
 public:
  /// Writes into `list`; derivatives are looked up in `derivatives`, which must outlive the writer.
  EquationWriter(EquationList& list, const Derivatives<Dim>& derivatives)
      : list_(list), derivatives_(derivatives) {
    slots_.fill(unknown);
    slots_[0] = value_only;
    for (int d = 0; d < derivatives.size(); ++d) {
      if (const int key = key_of(derivatives[d]); key >= 0) {
        slots_[key] = static_cast<std::int16_t>(d);
      }
    }
  }

  /// Sets the evaluation point of the equations that follow.
  void at(int point) { point_ = point; }
  /// Adds a term to the equation being written. Throws std::logic_error for an undeclared
  /// derivative.
  void add(int field, const MultiIndex<Dim>& alpha, double coefficient) {
    const int key = key_of(alpha);
    int slot = key < 0 ? unknown : slots_[key];
    if (slot == unknown) slot = derivatives_.index(alpha);
    list_.terms.push_back(
        {point_, static_cast<std::int16_t>(field), static_cast<std::int16_t>(slot), coefficient});
  }
  /// Adds a term on the unknown of a node of the sites, whatever its point's weights are.
  void add_unknown(int node, int field, double coefficient) {
    list_.terms.push_back({node, static_cast<std::int16_t>(field), value_only, coefficient});
  }
  /// Adds the terms of a row of another list, times a factor.
  void add_row(const EquationRow& row, double factor = 1) {
    for (Term term : row) {
      term.coefficient *= factor;
      list_.terms.push_back(term);
    }
  }
  /// True when a row reads values alone.
  bool is_value(const EquationRow& row) const {
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
    list_.end_row(right_hand_side, inertia);
  }

 private:
  static constexpr int unknown = -2;
  static constexpr int looked_up = 4;  ///< orders along each axis that a table serves, 0 to 3

  EquationList& list_;
  const Derivatives<Dim>& derivatives_;
  int point_ = 0;
  std::array<std::int16_t, 64> slots_{};  ///< by `key_of`

  /// Place of a derivative in the table, -1 where it has none.
  static int key_of(const MultiIndex<Dim>& alpha) {
    int key = 0;
    for (int c = 0; c < Dim; ++c) {
      if (alpha[c] >= looked_up) return -1;
      key = key * looked_up + alpha[c];
    }
    return key;
  }
};

}  // namespace strongpoint
