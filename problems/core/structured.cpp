#include "problems/core/structured.hpp"

#include <algorithm>
#include <cmath>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// True when a point lies on the surface of the unit cube.
template <int Dim>
bool on_unit_boundary(const Point<Dim>& unit) {
  return (unit.array() == 0).any() || (unit.array() == 1).any();
}

}  // namespace

std::vector<double> graded_axis(int n, double ratio) {
  const double growth = n > 2 ? std::pow(ratio, 1.0 / (n - 2)) : 1;
  std::vector<double> axis(n, 0.0);
  for (int i = 1; i < n; ++i) {
    // Equal spacings as integers: i / (n - 1) is then correctly rounded.
    axis[i] = axis[i - 1] + (ratio == 1 ? 1.0 : std::pow(growth, i - 1));
  }
  const double length = axis.back();
  for (double& x : axis) x /= length;
  return axis;
}

template <int Dim>
UnitLattice<Dim> tensor_lattice(const std::array<std::vector<double>, Dim>& axes) {
  UnitLattice<Dim> lattice;
  Eigen::Index count = 1;
  for (int c = 0; c < Dim; ++c) {
    lattice.block.shape[c] = static_cast<int>(axes[c].size());
    count *= lattice.block.shape[c];
  }
  lattice.nodes.resize(Dim, count);
  for (Eigen::Index id = 0; id < count; ++id) {
    Eigen::Index rest = id;
    for (int c = Dim - 1; c >= 0; --c) {
      const int n = lattice.block.shape[c];
      lattice.nodes(c, id) = axes[c][rest % n];
      rest /= n;
    }
  }
  return lattice;
}

template <int Dim>
std::array<int, Dim> stretched_counts(const Domain<Dim>& domain, int level, double stretch) {
  std::array<int, Dim> counts = domain.nodes_along(level);
  if (stretch == 1) return counts;
  if (Dim == 1) throw SkipCase("stretch: one axis has no other to be stretched against");
  const double others = std::pow(stretch, 1.0 / Dim);  // their product with the first axis is 1
  for (int c = 0; c < Dim; ++c) {
    const double cells = (counts[c] - 1) * (c == 0 ? others / stretch : others);
    counts[c] = 1 + std::max(1, static_cast<int>(std::lround(cells)));
  }
  return counts;
}

template <int Dim>
UnitLattice<Dim> graded_lattice(const Domain<Dim>& domain, int level, double ratio) {
  return graded_lattice<Dim>(domain.nodes_along(level), ratio);
}

template <int Dim>
UnitLattice<Dim> graded_lattice(const std::array<int, Dim>& counts, double ratio) {
  std::array<std::vector<double>, Dim> axes;
  for (int c = 0; c < Dim; ++c) axes[c] = graded_axis(counts[c], ratio);
  return tensor_lattice<Dim>(axes);
}

template <int Dim>
PointCloud<Dim> structured_cloud(const Domain<Dim>& domain, const UnitLattice<Dim>& lattice) {
  CloudBuilder<Dim> builder;
  for (Eigen::Index id = 0; id < lattice.nodes.cols(); ++id) {
    const Point<Dim> unit = lattice.nodes.col(id);
    const Point<Dim> x = domain.map(unit);
    if (on_unit_boundary<Dim>(unit)) {
      builder.add(x, domain.marks(domain.sides_at(unit), x));
    } else {
      builder.add(x);
    }
  }
  PointCloud<Dim> cloud = builder.finish(domain.measure());
  cloud.block = lattice.block;
  return cloud;
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same for each dimension */                        \
  template UnitLattice<Dim> tensor_lattice<Dim>(const std::array<std::vector<double>, Dim>&); \
  template std::array<int, Dim> stretched_counts<Dim>(const Domain<Dim>&, int, double);       \
  template UnitLattice<Dim> graded_lattice<Dim>(const std::array<int, Dim>&, double);         \
  template UnitLattice<Dim> graded_lattice(const Domain<Dim>&, int, double)
STRONGPOINT_INSTANTIATE(1);
STRONGPOINT_INSTANTIATE(2);
STRONGPOINT_INSTANTIATE(3);
#undef STRONGPOINT_INSTANTIATE
template PointCloud<1> structured_cloud(const Domain<1>&, const UnitLattice<1>&);
template PointCloud<2> structured_cloud(const Domain<2>&, const UnitLattice<2>&);
template PointCloud<3> structured_cloud(const Domain<3>&, const UnitLattice<3>&);

}  // namespace strongpoint
