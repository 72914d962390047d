#include "problems/core/voronoi.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/cell_maker.hpp"
#include "problems/core/cell_rings.hpp"
#include "problems/core/cell_visits.hpp"
#include "problems/core/cut_cells.hpp"

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
    const auto size = static_cast<int>(block.neighbours(0).size());
    if (size < 3 || size > most_ring_neighbours) {
      cells.farthest_squared.fill(std::numeric_limits<double>::infinity());
      return;
    }
    find_cell_rings({cloud_.nodes.data(), block.nodes.data(),
                     block.stencils.offsets.data() + block.first, block.stencils.nodes.data(),
                     block.size(), size, cells.measure.data(), cells.farthest_squared.data(),
                     nullptr, nullptr, nullptr});
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
    for (int i = 0; i < block.size(); ++i) {
      half_widths_[i] = box_for(reach_of(cloud_, block.nodes[i], block.neighbours(i)));
    }
    cut_cells({cloud_.nodes.data(), block.nodes.data(), block.stencils.offsets.data() + block.first,
               block.stencils.nodes.data(), block.size(), nullptr, 0, half_widths_.data(),
               work_.get(), cells.measure.data(), cells.farthest_squared.data(), states_.data()});
  }

 private:
  const PointCloud<3>& cloud_;
  std::unique_ptr<CutCell> work_;
  mutable std::array<double, cell_block_size> half_widths_;
  mutable std::array<CutState, cell_block_size> states_;
};

/// Measures cells, those inside by themselves and the others clipped by the domain.
template <int Dim>
class MeasureWorker {
 public:
  MeasureWorker(const PointCloud<Dim>& cloud, const Domain<Dim>& domain, Eigen::VectorXd& measures)
      : cloud_(cloud), domain_(domain), measures_(measures), free_(cloud), maker_(cloud, domain) {}

  void operator()(const CellBlock& block) {
    free_.make(block, cells_);
    for (int i = 0; i < block.size(); ++i) {
      const int node = block.nodes[i];
      const std::span<const int> neighbours = block.neighbours(i);
      const double depth = std::max(0.0, -domain_.distance(cloud_.nodes.col(node)));
      const double reach = reach_of(cloud_, node, neighbours);
      const bool is_settled = 4 * cells_.farthest_squared[i] <= reach * reach;
      if (depth * depth > cells_.farthest_squared[i] &&
          (is_settled || static_cast<int>(neighbours.size()) < cloud_.size())) {
        measures_[node] = cells_.measure[i];
        block.is_open[i] = is_settled ? 0 : 1;
      } else {
        const CellState state = maker_.make(node, neighbours);
        measures_[node] = state == CellState::unbounded ? std::numeric_limits<double>::infinity()
                                                        : maker_.cell().measure();
        block.is_open[i] = state == CellState::open ? 1 : 0;
      }
    }
  }

 private:
  const PointCloud<Dim>& cloud_;
  const Domain<Dim>& domain_;
  Eigen::VectorXd& measures_;
  FreeCellMaker<Dim> free_;
  FreeCells cells_;
  CellMaker<Dim> maker_;
};

}  // namespace

template <int Dim>
Eigen::VectorXd voronoi_volumes(const PointCloud<Dim>& cloud, const Domain<Dim>& domain,
                                const NeighbourSearch<Dim>& search) {
  const int count = cloud.size();
  Eigen::VectorXd volumes(count);
  visit_cells(cloud, search, [&] {
    return [worker = MeasureWorker<Dim>(cloud, domain, volumes)](const CellBlock& block) mutable {
      worker(block);
    };
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
