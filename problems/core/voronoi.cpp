#include "problems/core/voronoi.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/cell_maker.hpp"
#include "problems/core/cell_visits.hpp"

namespace strongpoint {

template <int Dim>
Eigen::VectorXd voronoi_volumes(const PointCloud<Dim>& cloud, const Domain<Dim>& domain,
                                const NeighbourSearch<Dim>& search) {
  const int count = cloud.size();
  Eigen::VectorXd volumes(count);
  visit_cells(cloud, search, [&] {
    return [&, maker = CellMaker<Dim>(cloud, domain)](int node,
                                                      std::span<const int> neighbours) mutable {
      const CellState state = maker.make(node, neighbours);
      volumes[node] = state == CellState::unbounded ? std::numeric_limits<double>::infinity()
                                                    : maker.cell().measure();
      return state != CellState::open;
    };
  });
  for (int i = 0; i < count; ++i) {
    if (volumes[i] > 0 && std::isfinite(volumes[i])) continue;
    throw CaseError(
        fmt::format("the Voronoi cell of node {} at {} has measure {:g}: move the node into the "
                    "domain, or remove "
                    "the nodes that coincide with it",
                    i, format_point(cloud.nodes.col(i)), volumes[i]));
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
