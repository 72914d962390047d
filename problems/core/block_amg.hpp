#pragma once

#include <optional>
#include <vector>

#include "problems/core/preconditioner.hpp"
#include "problems/core/transfer.hpp"
#include "problems/core/triangular_factors.hpp"

namespace strongpoint {

/// A level of multigrid: ILU(0) and the way to the next coarser one.
template <int Size, int Coarse>
class AmgLevel {
 public:
  /// `filled` is read as `block_ilu0` does.
  AmgLevel(const BlockMatrix<Size>& matrix, Transfer<Size, Coarse> transfer,
           SingleMatrix<Size, Coarse> fine_to_coarse, const std::vector<char>& filled = {});

  /// What is left of r on the coarser level.
  Eigen::VectorXf& restrict_to_coarse(const Eigen::VectorXf& r) const;
  /// Where its correction goes.
  Eigen::VectorXf& correction() const { return coarse_z_; }
  /// z = the correction and a sweep of ILU(0) on what it left of r.
  void smooth(const Eigen::VectorXf& r, Eigen::VectorXf& z) const;

  int shifted_pivots() const { return smoother_.shifted; }
  std::size_t bytes() const;

 private:
  BlockFactors<Size> smoother_;
  Transfer<Size, Coarse> transfer_;
  SingleMatrix<Size, Coarse> fine_to_coarse_;
  mutable Eigen::VectorXf residual_, coarse_r_, coarse_z_;
};

/// Algebraic multigrid by plain aggregation of nodes: a coarse correction, enlarged by a constant,
/// then one sweep of ILU(0); two cycles on every coarse level (W-cycle), direct factors on the
/// last. Aggregates of a plane elastic system whose places are known move as rigid bodies (Coarse
/// is 3), others are translated only. Two steps of a minimal residual instead of the W-cycle (the
/// K-cycle of Notay 2010) take as many iterations on fixed squares and cubes and stall where rows
/// are those of tractions on ghosts. Source: Stüben 2001, sections 4 and 9.1 (aggregation, enlarged
/// correction). Deviation: rows are summed as forces and moments, see `Balance`, or,
/// without places, after a product with the inverses of the diagonal blocks.
template <int Size, int Coarse = Size>
class BlockAmg : public Preconditioner {
 public:
  struct Parameters {
    StrongCouplings strong;     ///< that make aggregates
    double enlarge = 1.5;       ///< what a correction by constants is multiplied by; measured
    int coarsest_nodes = 1500;  ///< at most, on the level that is solved directly
  };
  /// How the unknowns move.
  struct Plane {
    PlaneBodies bodies;
    Eigen::VectorXd weights;   ///< of the rows
    std::vector<char> filled;  ///< (nodes) 1 for rows with fill in ILU(0): those of tractions
  };
  /// `plane` is read with rigid bodies, that is when Coarse is not Size. Throws CaseError as
  /// `block_ilu0` does and when the coarsest matrix is singular.
  BlockAmg(const BlockMatrix<Size>& matrix, const Parameters& parameters, Plane plane = {});

  using Preconditioner::apply;
  void apply(const Eigen::VectorXf& r, Eigen::VectorXf& z) const override;
  int shifted_pivots() const override;
  std::size_t bytes() const override;

 private:
  /// One of the coarser levels, with its matrix.
  struct Lower {
    SingleMatrix<Coarse> matrix;
    AmgLevel<Coarse, Coarse> level;
    mutable Eigen::VectorXf first, left;
  };
  Parameters parameters_;
  std::optional<AmgLevel<Size, Coarse>> finest_;
  std::vector<Lower> lower_;
  std::optional<TriangularFactors> factors_;
  mutable Eigen::VectorXd direct_r_, direct_z_;

  void factorise(const BlockMatrix<Coarse>& matrix);
  template <class Level>
  void cycle(const Level& level, std::size_t next, const Eigen::VectorXf& r,
             Eigen::VectorXf& z) const;
  void solve_coarse(std::size_t index, const Eigen::VectorXf& r, Eigen::VectorXf& z) const;
};

}  // namespace strongpoint
