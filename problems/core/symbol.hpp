#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "methods/core/weights.hpp"
#include "problems/core/problem.hpp"

namespace strongpoint {

/// A square matrix over the fields of a wave, (fields, fields), 3 at most.
template <class Scalar>
using FieldMatrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// What the differential equations at one place make of waves a exp(i (omega t - xi.x)): E a =
/// -omega^2 a with E_fg = sum over the terms of equation f on field g of coefficient (-i xi)^alpha
/// over the inertia, a real symmetric matrix. Source: thesis (4.34), (4.36).
template <int Dim>
class ExactSymbol {
 public:
  /// Takes the equations of a problem at a place. Throws SkipCase where they are none of waves that
  /// travel at one speed each: an equation without inertia, derivatives of an order other than 2,
  /// coefficients that are not symmetric.
  ExactSymbol(const SteadyProblem<Dim>& problem, const Place<Dim>& place);

  int fields() const { return fields_; }
  /// E, 1 over time squared; xi is the wave vector, 1 over length.
  FieldMatrix<double> at(const Point<Dim>& xi) const;

 private:
  /// A summand of E, over the inertia.
  struct Summand {
    int row, column;
    MultiIndex<Dim> alpha;
    double coefficient;
  };
  int fields_;
  std::vector<Summand> summands_;
};

/// What a discrete system makes of a wave at one node: S a = -omega^2 a with S_fg = sum_j A_fg,j
/// exp(-i xi.(x_j - x_i)) / inertia, A being the node's rows. Where unknowns are no nodal values, S
/// is divided by the same sum over the weights of the value at the node. On a cloud that repeats
/// itself from node to node S is the symbol of the whole system away from the boundary; on an
/// irregular one it is that of the node, and other nodes have others. Source: thesis (4.38).
template <int Dim>
class NodeSymbol {
 public:
  /// A symbol along a straight line of wave vectors.
  struct Along {
    FieldMatrix<std::complex<double>> symbol;  ///< S
    FieldMatrix<std::complex<double>> slope;   ///< dS / d|xi|
  };

  /// Takes the rows of one node, `first_row` and those that follow, one per field; the places of
  /// all nodes of the sites; and the position of the value among the derivatives of the weights,
  /// `value_only` where unknowns are values. Throws CaseError where weights are missing, SkipCase
  /// where a row has no inertia.
  NodeSymbol(const EquationList& equations, int first_row, int fields, const Weights& weights,
             const Points<Dim>& nodes, int node, int value_slot);

  int fields() const { return fields_; }
  /// S and its derivative along a unit vector; none where the wave has no value at the node.
  std::optional<Along> along(const Point<Dim>& xi, const Point<Dim>& direction) const;
  /// S alone, none where the wave has no value at the node.
  std::optional<FieldMatrix<std::complex<double>>> at(const Point<Dim>& xi) const;
  /// Size of what is summed up in S where the value is 1: eigenvalues are known to round-off of it.
  double scale() const { return scale_; }

 private:
  int fields_;
  Points<Dim> offsets_;     ///< (Dim, n) x_j - x_i
  Eigen::MatrixXd rows_;    ///< (fields * fields, n), column by column, over the inertia
  Eigen::VectorXd values_;  ///< (n) weights of the value, empty where unknowns are values
  double scale_ = 0;

  struct Entries;
};

}  // namespace strongpoint
