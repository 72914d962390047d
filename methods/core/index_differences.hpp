#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/local_method.hpp"
#include "methods/core/local_solvers.hpp"

namespace strongpoint {

/// Finite differences on a structured cloud: differences along the index lines and their products
/// D_xi^alpha, turned into derivatives in space by the discrete chain rule. Applied to the Taylor
/// monomials (x - x_i)^g / g! they give a square matrix B, and the weights are B^-1 D_xi: exact for
/// polynomials up to the order wherever the nodes lie. On a uniform grid B is diagonal, and the
/// weights are the usual finite differences.
/// Differences are central where the block reaches far enough, (order + 1) / 2 nodes to either
/// side: of even order, one more than asked for when that is odd. Elsewhere the first difference
/// takes order + 1 nodes and higher ones order + 2, shifted inwards: first and second derivatives
/// keep the order at the boundary. Source: Fornberg 1988; the chain rule in place of continuous
/// metric terms is ours.
template <int Dim>
class IndexDifferences {
 public:
  /// A difference along a line: the index offset of its first node, and its weights.
  struct Row {
    int first = 0;
    std::vector<double> weights;

    /// Weight at an index offset, zero where there is none.
    double at(int offset) const {
      const int i = offset - first;
      return i >= 0 && i < static_cast<int>(weights.size()) ? weights[i] : 0;
    }
  };
  /// Buffers of one thread.
  struct Workspace {
    double length = 1;                ///< mean distance of the index neighbours over R
    std::vector<int> offsets;         ///< (Dim, n) index offsets from the centre
    std::vector<const Row*> rows;     ///< (orders + 1, Dim) differences along each axis
    std::vector<double> functionals;  ///< (terms, n) D_xi^alpha, node after node
    std::vector<double> monomials;    ///< (terms) of one node
    std::vector<double> matrix;       ///< (terms, terms) B, row after row
    std::vector<double> round_off;    ///< (terms, terms) of the entries of B
    std::vector<double> solution;     ///< (terms)
    std::array<Lu, 2> systems;        ///< B up to the order; with order 1 also up to degree 2
  };

  /// Throws UsageError when the order is not within 1 to 8.
  explicit IndexDifferences(int order);

  /// Nodes along each axis of the index block that this takes.
  int width() const { return order_ + 2; }
  int needed_nodes() const;
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, Workspace& work) const;
  void evaluate(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
                const Derivatives<Dim>& derivatives, Eigen::Map<Eigen::MatrixXd> weights) const;
  /// B in units of the spacing, or with its columns in units of length.
  Eigen::MatrixXd local_matrix(const LocalStencil<Dim>& stencil, Scaling scaling) const;
  /// Derivatives up to the order can be given, and second ones.
  std::string unsupported(const Derivatives<Dim>& derivatives) const;

 private:
  int order_;
  Derivatives<Dim> terms_;
  std::vector<std::array<int, Dim>> lower_;  ///< of each term g, position of g - e_c; -1: the
                                             ///< constant, -2: there is none
  std::vector<Row> central_;                 ///< by order of the derivative
  std::vector<std::vector<Row>> shifted_;    ///< by order, then by nodes before the centre

  /// The difference along an axis on which the block reaches from offset `low` to `high`; null when
  /// that is too short.
  const Row* row_for(int order, int low, int high) const;
  /// Terms of the system from which a derivative is taken: 0 up to the order, 1 above it.
  int system_of(int derivative_order) const { return derivative_order > order_ ? 1 : 0; }
  /// Number of terms in a system.
  int system_size(int system) const;
  /// Finds offsets and rows. False when the stencil is no index block, or too small a one.
  bool find_rows(const LocalStencil<Dim>& stencil, Workspace& work) const;
  void fill_monomials(const Point<Dim>& z, std::vector<double>& monomials) const;
  /// Fills functionals and matrix; entries within their own round-off are zero.
  LocalOutcome assemble(const LocalStencil<Dim>& stencil, Workspace& work) const;
};

extern template class IndexDifferences<1>;
extern template class IndexDifferences<2>;
extern template class IndexDifferences<3>;

}  // namespace strongpoint
