#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "problems/core/solvers.hpp"

namespace strongpoint {

/// The units of a system's fields, those of a vector's components the same, and what its rows hold
/// of each.
class FieldUnits {
 public:
  explicit FieldUnits(const LinearSystem& system);

  int count() const { return static_cast<int>(sums_.rows()); }
  /// The unit of every unknown, (unknowns); empty when there is one unit.
  const std::vector<std::uint16_t>& of_unknowns() const { return of_unknowns_; }
  /// (units, rows) of |A|.
  const Eigen::MatrixXd& sums() const { return sums_; }
  /// The largest values of the fields of each unit, (units), or not a number.
  Eigen::VectorXd sizes(const Eigen::VectorXd& x) const;
  /// How many times as large each unit should be, (units), powers of two, for the entries of a row
  /// to be of one size, as far as that goes: least squares of the logarithms of the sums, with a
  /// free factor for every row. Units of the matrix make no difference but for the rounding.
  /// Source: Curtis and Reid 1972.
  Eigen::VectorXd even_sizes() const;

 private:
  std::vector<std::uint16_t> of_unknowns_;
  Eigen::MatrixXd sums_;
};

/// The system of the unknowns x_j / sizes(unit of j). Rows of a square system keep the size of
/// their largest entry; those of an overdetermined one, which count by their size, are not touched.
LinearSystem in_units(const LinearSystem& system, const FieldUnits& units,
                      const Eigen::VectorXd& sizes);

}  // namespace strongpoint
