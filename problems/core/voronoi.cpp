#include "problems/core/voronoi.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/cell_maker.hpp"
#include "problems/core/cell_visits.hpp"
#include "problems/core/reentrant_cells.hpp"
#include "problems/core/simd/cell_rings.hpp"
#include "problems/core/simd/cut_cells.hpp"
#include "problems/core/simd/walk_cells.hpp"

namespace strongpoint {
namespace {

/// Cells of a block among the neighbours alone, without the domain.
struct FreeCells {
  std::array<double, cell_block_size> measure;
  std::array<double, cell_block_size> farthest_squared;  ///< infinite where there is no such cell
};

/// Makes free cells for `MeasureWorker`.
template <int Dim>
class FreeCellMaker;

template <>
class FreeCellMaker<1> {
 public:
  explicit FreeCellMaker(const PointCloud<1>&) {}
  void make(const CellBlock&, FreeCells& cells) const {
    cells.farthest_squared.fill(std::numeric_limits<double>::infinity());
  }
};

template <>
class FreeCellMaker<2> {
 public:
  explicit FreeCellMaker(const PointCloud<2>& cloud) : cloud_(cloud) {}
  void make(const CellBlock& block, FreeCells& cells) const {
    for (int i = 0, together = 1; i < block.size(); i += together) {
      // Cells with as many neighbours as each other, all of them in the first round, go together.
      const std::size_t size = block.neighbours(i).size();
      together = 1;
      while (i + together < block.size() && block.neighbours(i + together).size() == size) {
        ++together;
      }
      if (size < 3 || size > most_ring_neighbours) {
        std::fill_n(cells.farthest_squared.data() + i, together,
                    std::numeric_limits<double>::infinity());
        continue;
      }
      find_cell_rings({cloud_.nodes.data(), block.nodes.data() + i,
                       block.stencils.offsets.data() + block.first + i, block.stencils.nodes.data(),
                       together, static_cast<int>(size), cells.measure.data() + i,
                       cells.farthest_squared.data() + i, nullptr, nullptr, nullptr});
    }
  }

 private:
  const PointCloud<2>& cloud_;
};

template <>
class FreeCellMaker<3> {
 public:
  explicit FreeCellMaker(const PointCloud<3>& cloud)
      : cloud_(cloud), work_(std::make_unique<CutCell>()) {}
  void make(const CellBlock& block, FreeCells& cells) const {
    // On a lattice walks fail where many edges meet: a few cells tell whether to go on with them.
    constexpr int trial = 16;
    const int tried = std::min(trial, block.size());
    const bool are_many = lanes_of(simd_path()) > 1;  // one lane is slower than a cut
    if (are_many && 2 * walk(block, 0, tried, cells) <= tried) {
      walk(block, tried, block.size(), cells);
    } else {
      for (int i = are_many ? tried : 0; i < block.size(); ++i) cut(block, i, cells);
    }
  }

 private:
  const PointCloud<3>& cloud_;
  std::unique_ptr<CutCell> work_;
  mutable std::array<WalkState, cell_block_size> states_;

  /// Walks around the cells from `first` on and cuts those where it fails; returns their number.
  int walk(const CellBlock& block, int first, int end, FreeCells& cells) const {
    int failed = 0;
    for (int i = first, together = 1; i < end; i += together) {
      const std::size_t size = block.neighbours(i).size();
      together = 1;
      while (i + together < end && block.neighbours(i + together).size() == size) ++together;
      if (size < 5 || size > most_walk_neighbours) {
        for (int j = i; j < i + together; ++j) cut(block, j, cells);
        continue;
      }
      walk_cells({cloud_.nodes.data(), block.nodes.data() + i,
                  block.stencils.offsets.data() + block.first + i, block.stencils.nodes.data(),
                  together, static_cast<int>(size), cells.measure.data() + i,
                  cells.farthest_squared.data() + i, states_.data() + i});
      for (int j = i; j < i + together; ++j) {
        if (states_[j] != WalkState::broken) continue;
        cut(block, j, cells);
        ++failed;
      }
    }
    return failed;
  }
  void cut(const CellBlock& block, int i, FreeCells& cells) const {
    const double half_width = box_for(block.reaches[i]);
    CutState state = CutState::broken;
    cut_cells({cloud_.nodes.data(), block.nodes.data() + i,
               block.stencils.offsets.data() + block.first + i, block.stencils.nodes.data(), 1,
               nullptr, 0, &half_width, work_.get(), cells.measure.data() + i,
               cells.farthest_squared.data() + i, &state});
  }
};

/// Measures cells, those inside by themselves and the others clipped by the domain.
template <int Dim>
class MeasureWorker {
 public:
  MeasureWorker(const PointCloud<Dim>& cloud, const Domain<Dim>& domain,
                const ReentrantSetting<Dim>& reentrant, Eigen::VectorXd& measures)
      : cloud_(cloud),
        domain_(domain),
        measures_(measures),
        free_(cloud),
        reentrant_(reentrant),
        maker_(cloud, domain) {}

  void operator()(const CellBlock& block) {
    free_.make(block, cells_);
    for (int i = 0; i < block.size(); ++i) {
      const int node = block.nodes[i];
      const std::span<const int> neighbours = block.neighbours(i);
      const double depth = std::max(0.0, -domain_.distance(cloud_.nodes.col(node)));
      const double reach = block.reaches[i];
      const double farthest_squared = cells_.farthest_squared[i];
      const bool is_settled = 4 * farthest_squared <= reach * reach;
      if (depth * depth > farthest_squared &&
          (is_settled || static_cast<int>(neighbours.size()) < cloud_.size())) {
        measures_[node] = cells_.measure[i];
        block.wanted[i] = is_settled ? 0 : 2 * std::sqrt(farthest_squared);
      } else {
        const std::optional<CellExtent> near = reentrant_.measure(node, neighbours, reach);
        const CellExtent extent = near ? *near : maker_.measure(node, neighbours, reach);
        measures_[node] = extent.measure;
        const bool is_open = extent.state == CellState::open;
        block.wanted[i] = is_open ? 2 * std::sqrt(extent.farthest_squared) : 0;
      }
    }
  }

 private:
  const PointCloud<Dim>& cloud_;
  const Domain<Dim>& domain_;
  Eigen::VectorXd& measures_;
  FreeCellMaker<Dim> free_;
  FreeCells cells_;
  ReentrantCells<Dim> reentrant_;
  CellMaker<Dim> maker_;
};

}  // namespace

template <int Dim>
Eigen::VectorXd voronoi_volumes(const PointCloud<Dim>& cloud, const Domain<Dim>& domain,
                                const NeighbourSearch<Dim>& search) {
  const int count = cloud.size();
  Eigen::VectorXd volumes(count);
  const ReentrantSetting<Dim> reentrant(cloud, domain);
  visit_cells(cloud, search, [&] {
    return [worker = MeasureWorker<Dim>(cloud, domain, reentrant, volumes)](
               const CellBlock& block) mutable { worker(block); };
  });
  for (int i = 0; i < count; ++i) {
    if (volumes[i] > 0 && std::isfinite(volumes[i])) continue;
    throw CaseError(
        fmt::format("the Voronoi cell of node {} at {} has measure {:g}: move the node into the "
                    "domain, or remove "
                    "the nodes that coincide with it",
                    cloud.number_of(i), format_point(cloud.nodes.col(i)), volumes[i]));
  }
  return volumes;
}

template Eigen::VectorXd voronoi_volumes<1>(const PointCloud<1>&, const Domain<1>&,
                                            const NeighbourSearch<1>&);
template Eigen::VectorXd voronoi_volumes<2>(const PointCloud<2>&, const Domain<2>&,
                                            const NeighbourSearch<2>&);
template Eigen::VectorXd voronoi_volumes<3>(const PointCloud<3>&, const Domain<3>&,
                                            const NeighbourSearch<3>&);

}  // namespace strongpoint
