#include "problems/core/elastic_problem.hpp"

#include <array>
#include <optional>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/face_directions.hpp"
#include "problems/core/norms.hpp"

namespace strongpoint {
OptionDoc unknowns_option() {
  return {"unknowns", "displacement", "displacement | mixed: with a pressure, for nu close to 0.5"};
}

Unknowns chosen_unknowns(const Options& options) {
  return options.choice<Unknowns>(
      "unknowns", {{"displacement", Unknowns::displacement}, {"mixed", Unknowns::mixed}});
}

Unknowns chosen_unknowns(const Options& options, double poisson) {
  const Unknowns unknowns = chosen_unknowns(options);
  if (unknowns == Unknowns::mixed && poisson == 0) {
    throw UsageError(
        options.where("unknowns") +
        "=mixed needs a Poisson's ratio above 0, as p = -lambda div u is zero without; "
        "leave it out");
  }
  return unknowns;
}

template <int Dim>
std::vector<std::string> ElasticProblem<Dim>::fields() const {
  static constexpr const char* names[] = {"u", "v", "w"};
  std::vector<std::string> all(names, names + Dim);
  if (is_mixed()) all.emplace_back("p");
  return all;
}

template <int Dim>
Derivatives<Dim> ElasticProblem<Dim>::derivatives(std::span<const BoundaryMark<Dim>> marks) const {
  const bool is_inside = marks.empty();
  if (is_inside && !varies() && !is_mixed()) return Derivatives<Dim>::between_orders(2, 2);
  if (is_inside) return Derivatives<Dim>::between_orders(1, 2);
  if (!is_mixed()) {
    for (const BoundaryMark<Dim>& mark : marks) {
      bool all_given = true;
      for (int i = 0; i < Dim; ++i) {
        all_given = all_given && known(i, mark.side) == Known::value;
      }
      if (all_given) return {};
    }
  }
  return first_derivatives();
}

template <int Dim>
void ElasticProblem<Dim>::governing(const Place<Dim>& place, EquationWriter<Dim>& write) const {
  const Lame lame = material(place);
  const Point<Dim> force = body_force(place);
  const LameGradient<Dim> gradient = varies() ? material_gradient(place) : LameGradient<Dim>{};
  for (int i = 0; i < Dim; ++i) {
    if (is_mixed()) {
      add_equilibrium<Dim>(write, Lame{0, lame.mu}, i);
      write.add(Dim, partial<Dim>(i), -1);
    } else {
      add_equilibrium<Dim>(write, lame, i);
    }
    if (varies()) add_gradient_terms<Dim>(write, gradient, is_mixed() ? 0.0 : 1.0, i);
    write.equals(-force[i], this->inertia(i, place));
  }
  if (is_mixed()) write_constraint(place, write);
}

template <int Dim>
void ElasticProblem<Dim>::write_constraint(const Place<Dim>& place,
                                           EquationWriter<Dim>& write) const {
  for (int i = 0; i < Dim; ++i) write.add(i, partial<Dim>(i), 1);
  write.add(Dim, MultiIndex<Dim>{}, 1 / material(place).lambda);
  write.equals(0);
}

template <int Dim>
void ElasticProblem<Dim>::boundary(const Node<Dim>& node, EquationWriter<Dim>& write) const {
  write_conditions(node, write);
  if (is_mixed()) write_constraint(node.place(), write);
}

/// With a pressure: the derivative of div u + p / lambda along the outward normal.
template <int Dim>
void ElasticProblem<Dim>::ghost(const Node<Dim>& node, EquationWriter<Dim>& write) const {
  write_conditions(node, write);
  if (!is_mixed()) return;
  Point<Dim> normal = Point<Dim>::Zero();
  for (const BoundaryMark<Dim>& mark : loaded_faces(node)) normal += mark.normal;
  normal.normalize();
  const double lambda = material(node.place()).lambda;
  for (int j = 0; j < Dim; ++j) {
    for (int i = 0; i < Dim; ++i) write.add(i, partial<Dim>(i, j), normal[j]);
    write.add(Dim, partial<Dim>(j), normal[j] / lambda);
  }
  if (varies()) {
    const double slope = normal.dot(material_gradient(node.place()).lambda);
    write.add(Dim, MultiIndex<Dim>{}, -slope / (lambda * lambda));
  }
  write.equals(0);
}

template <int Dim>
void ElasticProblem<Dim>::add_traction_along(const Place<Dim>& place, const Point<Dim>& m,
                                             const Point<Dim>& n,
                                             EquationWriter<Dim>& write) const {
  const Lame lame = material(place);
  add_traction<Dim>(write, is_mixed() ? Lame{0, lame.mu} : lame, m, n);
  if (is_mixed()) write.add(Dim, MultiIndex<Dim>{}, -m.dot(n));
}

template <int Dim>
void ElasticProblem<Dim>::write_traction(const Node<Dim>& node,
                                         std::span<const BoundaryMark<Dim>> faces,
                                         const Point<Dim>& m, EquationWriter<Dim>& write) const {
  double sum = 0;
  for (const BoundaryMark<Dim>& face : faces) {
    add_traction_along(node.place(), m, face.normal, write);
    for (int i = 0; i < Dim; ++i) {
      if (m[i] != 0) sum += m[i] * this->given(i, face.side, node.x);
    }
  }
  write.equals(sum);
}

template <int Dim>
std::vector<BoundaryMark<Dim>> ElasticProblem<Dim>::loaded_faces(const Node<Dim>& node) const {
  std::vector<BoundaryMark<Dim>> faces, supports;
  for (const BoundaryMark<Dim>& mark : node.marks) {
    int values = 0;
    for (int i = 0; i < Dim; ++i) values += known(i, mark.side) == Known::value ? 1 : 0;
    if (values == 0) {
      if (owns_corners(mark.side)) return {mark};
      faces.push_back(mark);
    } else if (values < Dim) {
      supports.push_back(mark);
    }
  }
  return faces.empty() ? supports : faces;
}

template <int Dim>
void ElasticProblem<Dim>::write_conditions(const Node<Dim>& node,
                                           EquationWriter<Dim>& write) const {
  std::array<std::optional<double>, Dim> values;
  std::vector<int> free_axes;
  for (int i = 0; i < Dim; ++i) {
    for (const BoundaryMark<Dim>& mark : node.marks) {
      if (!values[i] && known(i, mark.side) == Known::value) {
        values[i] = this->given(i, mark.side, node.x);
      }
    }
    if (!values[i]) free_axes.push_back(i);
  }
  const std::vector<BoundaryMark<Dim>> faces = loaded_faces(node);
  const bool by_face =
      faces.size() > 1 && faces.size() <= free_axes.size() && are_apart<Dim>(free_axes, faces);
  const std::vector<Point<Dim>> along =
      by_face ? directions_beside<Dim>(free_axes, faces) : std::vector<Point<Dim>>{};
  std::size_t row = 0;  // among those of the free components
  for (int i = 0; i < Dim; ++i) {
    if (values[i]) {
      write.add(i, MultiIndex<Dim>{}, 1);
      write.equals(*values[i]);
      continue;
    }
    if (!by_face) {
      write_traction(node, faces, Point<Dim>::Unit(i), write);
    } else if (row < faces.size()) {
      write_traction(node, std::span(faces).subspan(row, 1),
                     within<Dim>(free_axes, faces[row].normal), write);
    } else {
      write_traction(node, faces, along[row - faces.size()], write);
    }
    ++row;
  }
}

template <int Dim>
Eigen::MatrixXd ElasticProblem<Dim>::nodal_stresses(const Solution<Dim>& solution) const {
  const int count = solution.cloud.size();
  std::array<Eigen::VectorXd, Dim * Dim> slopes;
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) slopes[i * Dim + j] = solution.derivative(i, partial<Dim>(j));
  }
  Eigen::MatrixXd result(Dim * (Dim + 1) / 2, count);
  for (int n = 0; n < count; ++n) {
    Eigen::Matrix<double, Dim, Dim> gradient;
    for (int i = 0; i < Dim; ++i) {
      for (int j = 0; j < Dim; ++j) gradient(i, j) = slopes[i * Dim + j][n];
    }
    const Lame lame = material({solution.cloud.nodes.col(n), solution.cloud.patch_of(n)});
    Eigen::Matrix<double, Dim, Dim> sigma =
        stress<Dim>(is_mixed() ? Lame{0, lame.mu} : lame, gradient);
    if (is_mixed()) sigma.diagonal().array() -= solution.fields(Dim, n);
    result.col(n) = tensor_components<Dim>(sigma);
  }
  return result;
}

template <int Dim>
std::vector<double> ElasticProblem<Dim>::errors_at_nodes(const Solution<Dim>& solution) const {
  const std::optional<ElasticNodes> exact = exact_at_nodes(solution.cloud);
  return {relative_error(solution.fields.topRows(Dim), exact->fields),
          relative_error(nodal_stresses(solution), exact->stresses)};
}

template <int Dim>
void ElasticProblem<Dim>::add_pressure(const std::vector<Lame>& materials,
                                       ElasticNodes& exact) const {
  if (!is_mixed()) return;
  exact.fields.conservativeResize(Dim + 1, Eigen::NoChange);
  for (Eigen::Index n = 0; n < exact.fields.cols(); ++n) {
    exact.fields(Dim, n) =
        -volumetric_share<Dim>(materials[n]) * exact.stresses.col(n).template head<Dim>().sum();
  }
}

template <int Dim>
std::vector<NodeArray> ElasticProblem<Dim>::derived_fields(const Solution<Dim>& solution) const {
  std::vector<Lame> materials(solution.cloud.size());
  for (int n = 0; n < solution.cloud.size(); ++n) {
    materials[n] = material({solution.cloud.nodes.col(n), solution.cloud.patch_of(n)});
  }
  const Derivatives<Dim> measured = this->measured_derivatives();
  const Derivatives<Dim> first = first_derivatives();
  const bool has_stresses =
      std::all_of(first.begin(), first.end(), [&](const auto& d) { return measured.contains(d); });
  ElasticNodes computed{solution.fields, {}};
  if (has_stresses) computed.stresses = nodal_stresses(solution);
  std::optional<ElasticNodes> exact = exact_at_nodes(solution.cloud);
  if (exact) add_pressure(materials, *exact);
  return elastic_arrays<Dim>(fields(), materials, computed, exact);
}

template <int Dim>
std::vector<std::string> stress_names() {
  if constexpr (Dim == 2) return {"xx", "yy", "xy"};
  return {"xx", "yy", "zz", "xy", "xz", "yz"};
}

template <int Dim>
Eigen::Matrix<double, Dim*(Dim + 1) / 2, 1> tensor_components(
    const Eigen::Matrix<double, Dim, Dim>& tensor) {
  Eigen::Matrix<double, Dim*(Dim + 1) / 2, 1> all;
  all.template head<Dim>() = tensor.diagonal();
  int next = Dim;
  for (int i = 0; i < Dim; ++i) {
    for (int j = i + 1; j < Dim; ++j) all[next++] = tensor(i, j);
  }
  return all;
}

template class ElasticProblem<2>;
template class ElasticProblem<3>;
template std::vector<std::string> stress_names<2>();
template std::vector<std::string> stress_names<3>();
template Eigen::Matrix<double, 3, 1> tensor_components<2>(const Eigen::Matrix2d&);
template Eigen::Matrix<double, 6, 1> tensor_components<3>(const Eigen::Matrix3d&);

}  // namespace strongpoint
