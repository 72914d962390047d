#include "problems/core/interface_rows.hpp"

#include <algorithm>
#include <optional>

#include "methods/core/error.hpp"
#include "problems/core/face_directions.hpp"

namespace strongpoint {
namespace {

/// A side or an interface at the place of coincident nodes.
template <int Dim>
struct Face {
  BoundaryMark<Dim> mark;                          ///< the first of an interface's
  std::vector<std::pair<int, Point<Dim>>> shares;  ///< (node, outward normal) where flux is taken
};

/// Writes the conditions at one place where parts meet.
template <int Dim>
class Junction {
 public:
  Junction(const FluxProblem<Dim>& problem, const PointCloud<Dim>& cloud,
           const std::vector<int>& nodes)
      : problem_(problem), cloud_(cloud), nodes_(nodes) {
    for (int node : nodes_) is_in_patch_ &= cloud.patch_of(node) == cloud.patch_of(nodes_[0]);
    for (int node : nodes_) {
      for (const BoundaryMark<Dim>& mark : cloud.interfaces_of(node)) {
        if (seam_.shares.empty()) seam_.mark = mark;
        seam_.shares.emplace_back(node, mark.normal);
      }
      for (const BoundaryMark<Dim>& mark : cloud.marks_of(node)) add_side(node, mark);
    }
    const int fields = static_cast<int>(problem.fields().size());
    for (int f = 0; f < fields; ++f) {
      if (problem.vector_axis(f) >= 0) field_of_axis_[problem.vector_axis(f)] = f;
    }
  }

  /// Writes the row of a field with a flux; call it for all fields in their order.
  void write_condition(int field, EquationWriter<Dim>& write) {
    if (const std::optional<double> value = given_value(field)) {
      write.at(nodes_.back());
      write.add(field, MultiIndex<Dim>{}, 1);
      write.equals(*value);
    } else if (const int axis = problem_.vector_axis(field); axis < 0) {
      write_sum(field, sides_.empty() ? std::vector<Face<Dim>>{seam_} : sides_, write);
    } else {
      write_component(axis, write);
    }
  }

 private:
  const FluxProblem<Dim>& problem_;
  const PointCloud<Dim>& cloud_;
  const std::vector<int>& nodes_;
  std::vector<Face<Dim>> sides_;
  Face<Dim> seam_{};
  bool is_in_patch_ = true;
  std::array<int, Dim> field_of_axis_{};
  std::size_t row_ = 0;  ///< among those of vector components without a value

  /// Each side counts once: inside a patch at its first node, between patches at its last.
  void add_side(int node, const BoundaryMark<Dim>& mark) {
    for (Face<Dim>& side : sides_) {
      if (side.mark.side != mark.side) continue;
      if (!is_in_patch_) side.shares = {{node, mark.normal}};
      return;
    }
    sides_.push_back({mark, {{node, mark.normal}}});
  }

  std::optional<double> given_value(int field) const {
    for (const Face<Dim>& side : sides_) {
      if (problem_.known(field, side.mark.side) == Known::value) {
        return problem_.given(field, side.mark.side, cloud_.nodes.col(nodes_.back()));
      }
    }
    return {};
  }

  /// Adds `factor` times the flux of a field through a face. Gives what it equals.
  double add_flux(int field, const Face<Dim>& face, double factor,
                  EquationWriter<Dim>& write) const {
    for (const auto& [node, normal] : face.shares) {
      write.at(node);
      problem_.flux(field, {cloud_.nodes.col(node), cloud_.patch_of(node)}, factor * normal, write);
    }
    if (face.mark.side == interface_side) return 0;
    return factor * problem_.given(field, face.mark.side, cloud_.nodes.col(nodes_.back()));
  }

  void write_sum(int field, const std::vector<Face<Dim>>& faces, EquationWriter<Dim>& write) const {
    double sum = 0;
    for (const Face<Dim>& face : faces) sum += add_flux(field, face, 1, write);
    write.equals(sum);
  }

  void write_along(const Point<Dim>& direction, const Face<Dim>& face,
                   EquationWriter<Dim>& write) const {
    double sum = 0;
    for (int axis = 0; axis < Dim; ++axis) {
      if (direction[axis] == 0) continue;
      sum += add_flux(field_of_axis_[axis], face, direction[axis], write);
    }
    write.equals(sum);
  }

  /// Sides whose tractions are all given, or else those where some are.
  std::vector<Face<Dim>> loaded_sides() const {
    std::vector<Face<Dim>> loaded, supports;
    for (const Face<Dim>& side : sides_) {
      int values = 0;
      for (int field : field_of_axis_) {
        values += problem_.known(field, side.mark.side) == Known::value ? 1 : 0;
      }
      if (values == 0) loaded.push_back(side);
      if (values > 0 && values < Dim) supports.push_back(side);
    }
    return loaded.empty() && is_in_patch_ ? supports : loaded;
  }

  void write_component(int axis, EquationWriter<Dim>& write) {
    std::vector<int> free_axes;
    for (int a = 0; a < Dim; ++a) {
      if (!given_value(field_of_axis_[a])) free_axes.push_back(a);
    }
    std::vector<Face<Dim>> faces = loaded_sides();
    if (faces.empty() || (!is_in_patch_ && faces.size() < free_axes.size())) {
      faces.push_back(seam_);
    }
    const std::size_t row = row_++;
    std::vector<BoundaryMark<Dim>> marks;
    marks.reserve(faces.size());
    for (const Face<Dim>& face : faces) marks.push_back(face.mark);
    if (faces.size() == 1 || faces.size() > free_axes.size() || !are_apart<Dim>(free_axes, marks)) {
      write_sum(field_of_axis_[axis], faces, write);
    } else if (row < faces.size()) {
      write_along(within<Dim>(free_axes, faces[row].mark.normal), faces[row], write);
    } else {
      const std::vector<Point<Dim>> along = directions_beside<Dim>(free_axes, marks);
      double sum = 0;
      const Point<Dim>& direction = along[row - faces.size()];
      for (const Face<Dim>& face : faces) {
        for (int a = 0; a < Dim; ++a) {
          if (direction[a] != 0) sum += add_flux(field_of_axis_[a], face, direction[a], write);
        }
      }
      write.equals(sum);
    }
  }
};

}  // namespace

template <int Dim>
const FluxProblem<Dim>& interface_problem(const SteadyProblem<Dim>& problem) {
  const auto* with_flux = dynamic_cast<const FluxProblem<Dim>*>(&problem);
  if (with_flux != nullptr) return *with_flux;
  throw SkipCase("the problem states no fluxes, which interfaces between blocks balance");
}

template <int Dim>
Derivatives<Dim> interface_derivatives(const FluxProblem<Dim>& problem) {
  Derivatives<Dim> all = problem.flux_derivatives();
  const int fields = static_cast<int>(problem.fields().size());
  for (int f = 0; f < fields; ++f) {
    if (!problem.has_flux(f)) all.merge(problem.derivatives({}));
  }
  return all;
}

template <int Dim>
void write_interface(const FluxProblem<Dim>& problem, const PointCloud<Dim>& cloud, int node,
                     const Derivatives<Dim>& derivatives, EquationWriter<Dim>& write) {
  const std::span<const int> twins = cloud.twins_of(node);
  std::vector<int> nodes(twins.begin(), twins.end());
  nodes.insert(std::upper_bound(nodes.begin(), nodes.end(), node), node);
  Junction<Dim> junction(problem, cloud, nodes);
  const int fields = static_cast<int>(problem.fields().size());
  for (int f = 0; f < fields; ++f) {
    if (!problem.has_flux(f)) {
      EquationList own;
      EquationWriter<Dim> write_own(own, derivatives);
      write_own.at(node);
      problem.governing(node_of(cloud, node).place(), write_own);
      write.add_row(own.row(f));
      write.equals(own.right_hand_sides[f], own.inertia_of(f));
    } else if (node == nodes.back()) {
      junction.write_condition(f, write);
    } else {
      write.at(node);
      write.add(f, MultiIndex<Dim>{}, 1);
      write.at(nodes.back());
      write.add(f, MultiIndex<Dim>{}, -1);
      write.equals(0);
    }
  }
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same three for every dimension */         \
  template const FluxProblem<Dim>& interface_problem(const SteadyProblem<Dim>&);      \
  template Derivatives<Dim> interface_derivatives(const FluxProblem<Dim>&);           \
  template void write_interface(const FluxProblem<Dim>&, const PointCloud<Dim>&, int, \
                                const Derivatives<Dim>&, EquationWriter<Dim>&);
STRONGPOINT_INSTANTIATE(1)
STRONGPOINT_INSTANTIATE(2)
STRONGPOINT_INSTANTIATE(3)
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
