#include "studies/support/phases.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/LU>
#include <fmt/format.h>

#include "methods/core/condition.hpp"
#include "methods/core/error.hpp"
#include "methods/core/neighbours.hpp"
#include "methods/core/rule.hpp"
#include "studies/support/stage_clock.hpp"

namespace strongpoint {
namespace {

constexpr double largest_condition = 4e8;  // C_max that reproduces the thesis' stencils
constexpr int block_size = 64;             // centres timed together: the clock costs nothing then

enum Phase { search, selection, matrix, scaling, condition, growth, inversion, operator_rows };

/// One centre on its way through the phases.
template <int Dim>
struct Centre {
  std::vector<int> near;        ///< candidates by distance
  std::vector<int> nodes;       ///< the stencil
  Eigen::MatrixXd projections;  ///< (m, n) projection functions times T^2
  Eigen::MatrixXd local;        ///< (m, m) A, then S A
  Eigen::MatrixXd inverse;      ///< (m, m)
  Eigen::VectorXd scale;        ///< (m) diagonal of S
  double condition = 0;
};

template <int Dim>
class Phases {
 public:
  Phases(const PointCloud<Dim>& cloud, const Eigen::VectorXd& volumes, const TaylorFit<Dim>& fit,
         int stencil_size, PhaseAlgorithm algorithm)
      : fit_(fit),
        size_(stencil_size),
        algorithm_(algorithm),
        sites_(sites_at_nodes<Dim>(cloud.nodes)) {
    sites_.volumes = volumes;
    run_.weights.per_entry = fit.unknowns();
    if (algorithm == PhaseAlgorithm::cells) {
      clock_.time(run_.seconds[search], [&] { cells_ = make_search<Dim>("grid", sites_.nodes); });
    }
  }

  PhaseRun run() {
    for (int first = 0; first < sites_.node_count(); first += block_size) {
      const int count = std::min(block_size, sites_.node_count() - first);
      std::vector<Centre<Dim>> centres(count);
      timed(search, [&] { find_candidates(first, centres); });
      timed(selection, [&] { each(first, centres, &Phases::select); });
      timed(matrix, [&] { each(first, centres, &Phases::build); });
      timed(scaling, [&] { each(first, centres, &Phases::scale); });
      timed(condition, [&] { each(first, centres, &Phases::judge); });
      timed(growth, [&] { each(first, centres, &Phases::grow); });
      timed(inversion, [&] { each(first, centres, &Phases::invert); });
      timed(operator_rows, [&] { each(first, centres, &Phases::write_rows); });
    }
    return std::move(run_);
  }

 private:
  const TaylorFit<Dim>& fit_;
  int size_;
  PhaseAlgorithm algorithm_;
  Sites<Dim> sites_;
  std::unique_ptr<NeighbourSearch<Dim>> cells_;
  StageClock clock_{1};
  PhaseRun run_;

  template <class Work>
  void timed(Phase phase, Work&& work) {
    clock_.time(run_.seconds[phase], std::forward<Work>(work));
  }
  void each(int first, std::vector<Centre<Dim>>& centres, void (Phases::*step)(int, Centre<Dim>&)) {
    for (std::size_t i = 0; i < centres.size(); ++i)
      (this->*step)(first + static_cast<int>(i), centres[i]);
  }

  /// Candidates beyond those the first stencil takes serve the growth.
  int candidates() const { return 3 * size_; }

  void find_candidates(int first, std::vector<Centre<Dim>>& centres) {
    if (algorithm_ == PhaseAlgorithm::cells) {
      std::vector<int> ids(centres.size());
      std::iota(ids.begin(), ids.end(), first);
      const Stencils near =
          cells_->nearest(columns_of<Dim>(sites_.nodes, ids), candidates(), Ties::keep);
      for (std::size_t i = 0; i < centres.size(); ++i) {
        const std::span<const int> nodes = near[static_cast<int>(i)];
        centres[i].near.assign(nodes.begin(), nodes.end());
      }
      return;
    }
    std::vector<std::pair<double, int>> all(sites_.node_count());
    for (std::size_t i = 0; i < centres.size(); ++i) {
      for (int j = 0; j < sites_.node_count(); ++j) {
        all[j] = {squared_distance(sites_, first + static_cast<int>(i), j), j};
      }
      std::sort(all.begin(), all.end());
      const int count = std::min(candidates(), sites_.node_count());
      const double bound = all[count - 1].first * (1 + 2 * tie_tolerance);
      for (int j = 0; j < sites_.node_count() && all[j].first <= bound; ++j) {
        centres[i].near.push_back(all[j].second);
      }
    }
  }

  /// Takes at least `wanted` candidates, with the ties of the last.
  void take(int node, Centre<Dim>& centre, std::size_t wanted) {
    if (wanted > centre.near.size()) {
      throw CaseError(fmt::format(
          "the stencil of node {} at {} stays ill-conditioned with {} nodes; use more "
          "or other nodes",
          sites_.number_of(node), format_point(sites_.nodes.col(node)), centre.near.size()));
    }
    const double bound =
        squared_distance(sites_, node, centre.near[wanted - 1]) * (1 + 2 * tie_tolerance);
    std::size_t count = wanted;
    while (count < centre.near.size() &&
           squared_distance(sites_, node, centre.near[count]) <= bound) {
      ++count;
    }
    centre.nodes.assign(centre.near.begin(),
                        centre.near.begin() + static_cast<std::ptrdiff_t>(count));
  }
  void select(int node, Centre<Dim>& centre) {
    take(node, centre, std::min<std::size_t>(size_, centre.near.size()));
  }

  /// A = sum_j W_j (Taylor terms)_j in the problem's own length unit.
  void build(int node, Centre<Dim>& centre) {
    const int m = fit_.unknowns();
    const auto n = static_cast<Eigen::Index>(centre.nodes.size());
    LocalStencil<Dim> stencil;
    if (stencil.gather(sites_, centre.nodes, node) != LocalOutcome::ok) {
      throw CaseError(
          fmt::format("the stencil of node {} holds coincident nodes", sites_.number_of(node)));
    }
    std::vector<double> squared;
    fit_.evaluate_weights(stencil, squared);
    Eigen::MatrixXd monomials(m, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const Point<Dim> offset = sites_.nodes.col(centre.nodes[j]) - sites_.nodes.col(node);
      fit_.evaluate_monomials(offset.data(), monomials.col(j).data());
    }
    centre.projections = monomials * Eigen::Map<Eigen::VectorXd>(squared.data(), n).asDiagonal();
    for (int a = 0; a < m; ++a) monomials.row(a) /= factorial<Dim>(fit_.monomials()[a]);
    centre.local = centre.projections * monomials.transpose();
    centre.scale.resize(m);
    for (int a = 0; a < m; ++a) {
      centre.scale[a] = std::pow(stencil.radius, -order_of<Dim>(fit_.monomials()[a]));
    }
  }

  void scale(int, Centre<Dim>& centre) { centre.local = centre.scale.asDiagonal() * centre.local; }

  void judge(int, Centre<Dim>& centre) {
    if (algorithm_ == PhaseAlgorithm::cells) {
      centre.condition = condition_number(centre.local, ConditionNorm::two);
    } else {
      centre.condition = 1 / Eigen::PartialPivLU<Eigen::MatrixXd>(centre.local).rcond();
    }
  }

  void grow(int node, Centre<Dim>& centre) {
    while (!(centre.condition <= largest_condition)) {
      take(node, centre, centre.nodes.size() + 1);
      build(node, centre);
      scale(node, centre);
      judge(node, centre);
    }
  }

  void invert(int, Centre<Dim>& centre) { centre.inverse = centre.local.inverse(); }

  /// D = (S A)^-1 S (W - B): the centre's column balances the others.
  void write_rows(int node, Centre<Dim>& centre) {
    Eigen::MatrixXd rows = centre.inverse * centre.scale.asDiagonal() * centre.projections;
    const auto place = std::find(centre.nodes.begin(), centre.nodes.end(), node);
    const auto self = static_cast<Eigen::Index>(place - centre.nodes.begin());
    rows.col(self).setZero();
    rows.col(self) = -rows.rowwise().sum();
    run_.stencils.push_back(centre.nodes);
    run_.weights.columns.insert(run_.weights.columns.end(), centre.nodes.begin(),
                                centre.nodes.end());
    run_.weights.values.insert(run_.weights.values.end(), rows.data(), rows.data() + rows.size());
    run_.weights.offsets.push_back(static_cast<std::int64_t>(run_.weights.columns.size()));
  }
};

}  // namespace

template <int Dim>
PhaseRun run_phases(const PointCloud<Dim>& cloud, const Eigen::VectorXd& volumes,
                    const TaylorFit<Dim>& fit, int stencil_size, PhaseAlgorithm algorithm) {
  return Phases<Dim>(cloud, volumes, fit, stencil_size, algorithm).run();
}

template PhaseRun run_phases(const PointCloud<1>&, const Eigen::VectorXd&, const TaylorFit<1>&, int,
                             PhaseAlgorithm);
template PhaseRun run_phases(const PointCloud<2>&, const Eigen::VectorXd&, const TaylorFit<2>&, int,
                             PhaseAlgorithm);
template PhaseRun run_phases(const PointCloud<3>&, const Eigen::VectorXd&, const TaylorFit<3>&, int,
                             PhaseAlgorithm);

}  // namespace strongpoint
