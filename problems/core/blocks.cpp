#include "problems/core/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "methods/core/fornberg.hpp"
#include "problems/core/gauss_legendre.hpp"
#include "problems/core/structured.hpp"

namespace strongpoint {
namespace {

/// One cell of a split block.
template <int Dim>
struct Cell {
  const Block<Dim>& block;
  std::array<int, Dim> index;  ///< along each axis
  const std::array<std::vector<double>, Dim>& ends;

  /// The block's unit coordinates; cells that share a face get the same bits on it.
  Point<Dim> unit(const Point<Dim>& own) const {
    Point<Dim> x;
    for (int c = 0; c < Dim; ++c) {
      x[c] = (1 - own[c]) * ends[c][index[c]] + own[c] * ends[c][index[c] + 1];
    }
    return x;
  }
  int side(int face) const {
    const int c = face / 2;
    const int last = static_cast<int>(ends[c].size()) - 2;
    const bool is_outer = index[c] == (face % 2 == 0 ? 0 : last);
    return is_outer ? block.sides[face] : interface_side;
  }
  std::vector<BoundaryMark<Dim>> marks(const Domain<Dim>& domain, const Point<Dim>& own,
                                       const Point<Dim>& x) const {
    std::vector<BoundaryMark<Dim>> all;
    for (int face = 0; face < 2 * Dim; ++face) {
      if (own[face / 2] != face % 2) continue;
      const int of_face = side(face);
      all.push_back(
          {of_face, of_face == interface_side ? normal(face, own) : domain.normal(of_face, x)});
    }
    return all;
  }
  /// Outward unit normal of a face: the gradient of the coordinate that is constant on it.
  Point<Dim> normal(int face, const Point<Dim>& own) const {
    const Eigen::Matrix<double, Dim, Dim> gradients = jacobian<Dim>(block.map, unit(own)).inverse();
    return (face % 2 == 0 ? -1 : 1) * gradients.row(face / 2).transpose().normalized();
  }
};

/// The indices of all cells, the last one fastest.
template <int Dim>
std::vector<std::array<int, Dim>> cells_of(const std::array<std::vector<double>, Dim>& ends) {
  std::vector<std::array<int, Dim>> all{{}};
  for (int c = 0; c < Dim; ++c) {
    std::vector<std::array<int, Dim>> next;
    for (std::array<int, Dim> index : all) {
      const int cells = static_cast<int>(ends[c].size()) - 1;
      for (index[c] = 0; index[c] < cells; ++index[c]) next.push_back(index);
    }
    all = std::move(next);
  }
  return all;
}

}  // namespace

std::vector<double> block_axis(BlockNodes nodes, int n) {
  if (nodes == BlockNodes::gll) return gauss_lobatto(n).at;
  if (nodes == BlockNodes::uniform) return graded_axis(n, 1);
  constexpr double clustering = 0.9;
  std::vector<double> axis(n);
  for (int i = 0; i < n; ++i) {
    double x = -std::cos(std::numbers::pi * i / (n - 1));
    if (2 * i == n - 1) x = 0;
    if (nodes == BlockNodes::clustered) x = std::asin(clustering * x) / std::asin(clustering);
    axis[i] = (1 + x) / 2;
  }
  axis.front() = 0;
  axis.back() = 1;
  return axis;
}

std::vector<double> cell_ends(int cells, double ratio) {
  std::vector<double> ends{0};
  for (int i = 0; i < cells; ++i) {
    ends.push_back(ends.back() + std::pow(ratio, std::abs(i - (cells - 1) / 2.0)));
  }
  const double length = ends.back();
  for (double& end : ends) end /= length;
  return ends;
}

template <int Dim>
Eigen::Matrix<double, Dim, Dim> jacobian(const std::function<Point<Dim>(const Point<Dim>&)>& map,
                                         const Point<Dim>& unit) {
  constexpr int count = 13;       // the error of an analytic map is below round-off,
  constexpr double width = 0.25;  // which these divide by the window's width
  const std::vector<double> window = block_axis(BlockNodes::chebyshev, count);
  Eigen::Matrix<double, Dim, Dim> result = Eigen::Matrix<double, Dim, Dim>::Zero();
  for (int c = 0; c < Dim; ++c) {
    const double first = std::clamp(unit[c] - width / 2, 0.0, 1 - width);
    std::vector<double> at = window;
    for (double& z : at) z = first + width * z;
    const Eigen::MatrixXd weights = fornberg_weights(at, unit[c], 1);
    Point<Dim> x = unit;
    for (int i = 0; i < count; ++i) {
      x[c] = at[i];
      result.col(c) += weights(1, i) * map(x);
    }
  }
  return result;
}

template <int Dim>
PointCloud<Dim> block_cloud(const Domain<Dim>& domain, const std::vector<double>& axis,
                            const std::array<std::vector<double>, Dim>& ends) {
  std::array<std::vector<double>, Dim> axes;
  axes.fill(axis);
  UnitLattice<Dim> lattice = tensor_lattice<Dim>(axes);
  lattice.block.axes.fill(axis);
  const std::vector<Block<Dim>> blocks = domain.blocks();
  const std::vector<std::array<int, Dim>> indices = cells_of<Dim>(ends);
  const bool is_one = blocks.size() * indices.size() == 1;
  CloudBuilder<Dim> builder;
  for (const Block<Dim>& block : blocks) {
    for (const std::array<int, Dim>& index : indices) {
      const Cell<Dim> cell{block, index, ends};
      if (!is_one) builder.begin_part(0, lattice.block);
      for (Eigen::Index id = 0; id < lattice.nodes.cols(); ++id) {
        const Point<Dim> own = lattice.nodes.col(id);
        const Point<Dim> x = block.map(cell.unit(own));
        builder.add(x, cell.marks(domain, own, x));
      }
    }
  }
  PointCloud<Dim> cloud = builder.finish(domain.measure());
  if (is_one) cloud.block = lattice.block;
  return cloud;
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same two for every dimension */                 \
  template Eigen::Matrix<double, Dim, Dim> jacobian<Dim>(                                   \
      const std::function<Point<Dim>(const Point<Dim>&)>&, const Point<Dim>&);              \
  template PointCloud<Dim> block_cloud<Dim>(const Domain<Dim>&, const std::vector<double>&, \
                                            const std::array<std::vector<double>, Dim>&);
STRONGPOINT_INSTANTIATE(1)
STRONGPOINT_INSTANTIATE(2)
STRONGPOINT_INSTANTIATE(3)
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
