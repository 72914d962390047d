#include "methods/core/spacing.hpp"

#include <algorithm>

namespace strongpoint {

template <int Dim>
Eigen::VectorXd local_spacing(const Points<Dim>& queries, const Points<Dim>& nodes,
                              const NeighbourSearch<Dim>& search) {
  constexpr int block = Dim == 1 ? 3 : Dim == 2 ? 9 : 27;
  const Stencils near = search.nearest(nodes, Dim + 1, Ties::cut);
  Eigen::VectorXd of_node(nodes.cols());
  for (int i = 0; i < nodes.cols(); ++i) {
    of_node[i] = (nodes.col(near[i].back()) - nodes.col(i)).norm();
  }
  const Stencils around = search.nearest(queries, block, Ties::keep);
  Eigen::VectorXd result(queries.cols());
  for (int q = 0; q < queries.cols(); ++q) {
    double sum = 0;
    for (int node : around[q]) sum += of_node[node];
    result[q] = sum / static_cast<double>(around[q].size());
  }
  return result;
}

template Eigen::VectorXd local_spacing<1>(const Points<1>&, const Points<1>&,
                                          const NeighbourSearch<1>&);
template Eigen::VectorXd local_spacing<2>(const Points<2>&, const Points<2>&,
                                          const NeighbourSearch<2>&);
template Eigen::VectorXd local_spacing<3>(const Points<3>&, const Points<3>&,
                                          const NeighbourSearch<3>&);

}  // namespace strongpoint
