#pragma once

#include <optional>
#include <vector>

#include "problems/core/aggregation.hpp"
#include "problems/core/preconditioner.hpp"
#include "problems/core/triangular_factors.hpp"

namespace strongpoint {

/// Algebraic multigrid by plain aggregation of nodes: a coarse correction, enlarged by a constant,
/// then one sweep of ILU(0); two cycles on every coarse level (W-cycle), direct factors on the
/// last. Translations alone are interpolated. Two steps of a minimal residual instead (the K-cycle
/// of Notay 2010) take as many iterations on fixed squares and cubes and stall where rows are those
/// of tractions on ghosts. Source: Stüben 2001, sections 4 and 9.1 (aggregation, enlarged
/// correction).
template <int Size>
class BlockAmg : public Preconditioner {
 public:
  struct Parameters {
    StrongCouplings strong;     ///< that make aggregates
    double enlarge = 1.5;       ///< what a correction by constants is multiplied by; measured
    int coarsest_nodes = 1500;  ///< at most, on the level that is solved directly
  };
  /// Throws CaseError as `block_ilu0` does and when the coarsest matrix is singular.
  BlockAmg(const BlockMatrix<Size>& matrix, const Parameters& parameters);

  using Preconditioner::apply;
  void apply(const Eigen::VectorXf& r, Eigen::VectorXf& z) const override;
  int shifted_pivots() const override;
  std::size_t bytes() const override;

 private:
  /// A level and the way to the next coarser one.
  struct Level {
    SingleMatrix<Size> matrix;  ///< empty on the finest, which needs none
    BlockFactors<Size> smoother;
    std::vector<int> aggregates;  ///< (rows) of each, or -1
    SingleMatrix<Size> fine_to_coarse;
    std::vector<float> inverses;  ///< (rows * Size * Size) of the diagonal blocks
    int coarse_rows = 0;
    mutable Eigen::VectorXf residual, coarse_r, coarse_z, first, left;
  };
  Parameters parameters_;
  std::vector<Level> levels_;
  std::optional<TriangularFactors> factors_;
  mutable Eigen::VectorXd direct_r_, direct_z_;

  BlockMatrix<Size> add_level(const BlockMatrix<Size>& matrix, const Aggregates& aggregates);
  void factorise(const BlockMatrix<Size>& matrix);
  void restrict_to_coarse(const Level& level, const Eigen::VectorXf& r) const;
  void cycle(std::size_t level, const Eigen::VectorXf& r, Eigen::VectorXf& z) const;
  void solve_coarse(std::size_t level, const Eigen::VectorXf& r, Eigen::VectorXf& z) const;
};

}  // namespace strongpoint
