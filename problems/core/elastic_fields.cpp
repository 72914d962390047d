#include "problems/core/elastic_fields.hpp"

#include <cmath>

#include "problems/core/elastic_problem.hpp"

namespace strongpoint {
namespace {

/// Stresses as one array a component, then von Mises'; none of no stresses.
template <int Dim>
std::vector<NodeArray> stress_arrays(const Eigen::MatrixXd& stresses,
                                     const std::vector<Lame>& materials) {
  std::vector<NodeArray> arrays;
  if (stresses.size() == 0) return arrays;
  const std::vector<std::string> names = stress_names<Dim>();
  for (int c = 0; c < stresses.rows(); ++c) {
    arrays.push_back({(c < Dim ? "sigma_" : "tau_") + names[c], stresses.row(c)});
  }
  NodeArray equivalent{"von_mises", Eigen::MatrixXd(1, stresses.cols())};
  for (Eigen::Index i = 0; i < stresses.cols(); ++i) {
    equivalent.values(0, i) = von_mises<Dim>(stresses.col(i), materials[i]);
  }
  arrays.push_back(std::move(equivalent));
  return arrays;
}

}  // namespace

template <int Dim>
double von_mises(const Eigen::Matrix<double, Dim*(Dim + 1) / 2, 1>& stress, const Lame& material) {
  const Eigen::Array<double, Dim, 1> own = stress.template head<Dim>();
  Eigen::Array3d normal = Eigen::Array3d::Constant(volumetric_share<Dim>(material) * own.sum());
  normal.head<Dim>() = own;
  normal -= normal.mean();
  const double shear = stress.template tail<Dim*(Dim - 1) / 2>().squaredNorm();
  return std::sqrt(1.5 * (normal.square().sum() + 2 * shear));
}

template <int Dim>
std::vector<NodeArray> elastic_arrays(const std::vector<std::string>& names,
                                      const std::vector<Lame>& materials,
                                      const ElasticNodes& computed,
                                      const std::optional<ElasticNodes>& exact) {
  NodeArray displacement{"displacement", Eigen::MatrixXd::Zero(3, computed.fields.cols())};
  displacement.values.topRows<Dim>() = computed.fields.topRows<Dim>();
  std::vector<NodeArray> arrays{std::move(displacement)};
  const std::vector<NodeArray> stresses = stress_arrays<Dim>(computed.stresses, materials);
  arrays.insert(arrays.end(), stresses.begin(), stresses.end());
  if (!exact) return arrays;
  for (int f = 0; f < exact->fields.rows(); ++f) {
    arrays.push_back(error_array(names[f], computed.fields.row(f), exact->fields.row(f)));
  }
  const std::vector<NodeArray> given = stress_arrays<Dim>(exact->stresses, materials);
  for (std::size_t a = 0; a < stresses.size(); ++a) {
    arrays.push_back(error_array(stresses[a].name, stresses[a].values, given[a].values));
  }
  return arrays;
}

template double von_mises<2>(const Eigen::Vector3d&, const Lame&);
template double von_mises<3>(const Eigen::Matrix<double, 6, 1>&, const Lame&);
template std::vector<NodeArray> elastic_arrays<2>(const std::vector<std::string>&,
                                                  const std::vector<Lame>&, const ElasticNodes&,
                                                  const std::optional<ElasticNodes>&);
template std::vector<NodeArray> elastic_arrays<3>(const std::vector<std::string>&,
                                                  const std::vector<Lame>&, const ElasticNodes&,
                                                  const std::optional<ElasticNodes>&);

}  // namespace strongpoint
