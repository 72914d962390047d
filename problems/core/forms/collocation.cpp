#include <algorithm>

#include <fmt/format.h>

#include "methods/core/neighbours.hpp"
#include "problems/core/form.hpp"
#include "problems/core/ghosts.hpp"
#include "problems/core/interface_rows.hpp"
#include "problems/core/mirror.hpp"
#include "problems/core/side_nodes.hpp"

namespace strongpoint {
namespace {

/// How conditions on derivatives are written at boundary nodes.
enum class Boundary {
  plain,    ///< in place of the differential equations
  ghost,    ///< at a node added outside, whose unknowns make room for the differential equations
  combined  ///< added to alpha h times the differential equations
};

/// Writes the equations of all nodes, and of their ghosts.
template <int Dim>
class CollocationRows {
 public:
  CollocationRows(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                  std::vector<SymmetryPlane> planes, Ghosts<Dim> ghosts, double alpha)
      : problem_(problem),
        cloud_(cloud),
        planes_(std::move(planes)),
        ghosts_(std::move(ghosts)),
        alpha_(alpha),
        fields_(static_cast<int>(problem.fields().size())) {}

  EquationList operator()(const Derivatives<Dim>& derivatives) const {
    EquationList list;
    EquationWriter<Dim> write(list, derivatives);
    Scratch scratch(derivatives);
    list.reserve((cloud_.size() + ghosts_.size()) * fields_);
    const double spacing = cloud_.spacing();
    for (int i = 0; i < cloud_.size(); ++i) {
      const Node<Dim> node = node_of(cloud_, i, spacing);
      write.at(i);
      if (!cloud_.twins_of(i).empty()) {
        write_interface(*flux_problem(problem_), cloud_, i, derivatives, write);
      } else if (node.marks.empty()) {
        problem_.governing(node.place(), write);
      } else if (lies_on_planes_only<Dim>(node.marks, planes_)) {
        write_on_planes(node, scratch, write);
      } else if (alpha_ > 0) {
        write_combined(node, scratch, write);
      } else if (ghosts_.of_node[i] >= 0) {
        write_beside_ghost(node, scratch, write);
      } else {
        problem_.boundary(node, write);
      }
    }
    for (int ghost = 0; ghost < ghosts_.size(); ++ghost) write_ghost(ghost, scratch, write);
    return list;
  }

 private:
  /// Rows of one node, before it is decided what becomes of them.
  struct Rows {
    EquationList list;
    EquationWriter<Dim> write;

    explicit Rows(const Derivatives<Dim>& derivatives) : write(list, derivatives) {}
    void at(int point) {
      list.clear();
      write.at(point);
    }
    bool is_value(int row) const { return write.is_value(list.row(row)); }
  };
  struct Scratch {
    Rows governing, boundary, ghost;

    explicit Scratch(const Derivatives<Dim>& derivatives)
        : governing(derivatives), boundary(derivatives), ghost(derivatives) {}
  };

  const SteadyProblem<Dim>& problem_;
  const PointCloud<Dim>& cloud_;
  std::vector<SymmetryPlane> planes_;
  Ghosts<Dim> ghosts_;
  double alpha_;
  int fields_;

  static void copy_row(const Rows& rows, int row, EquationWriter<Dim>& write) {
    write.add_row(rows.list.row(row));
    write.equals(rows.list.right_hand_sides[row], rows.list.inertia_of(row));
  }

  /// True when a mirrored plane through the node reverses a field, which is zero there.
  bool is_reversed(const Node<Dim>& node, int field) const {
    return std::any_of(planes_.begin(), planes_.end(), [&](const SymmetryPlane& plane) {
      return node.on(plane.side) && problem_.vector_axis(field) == plane.axis;
    });
  }

  /// The differential equations hold on a mirrored plane as they do inside.
  void write_on_planes(const Node<Dim>& node, Scratch& scratch, EquationWriter<Dim>& write) const {
    scratch.governing.at(node.id);
    problem_.governing(node.place(), scratch.governing.write);
    for (int f = 0; f < fields_; ++f) {
      if (is_reversed(node, f)) {
        write.add(f, MultiIndex<Dim>{}, 1);
        write.equals(0);
      } else {
        copy_row(scratch.governing, f, write);
      }
    }
  }

  /// Given values, or sum of (flux - given) over the sides - alpha h (governing).
  void write_combined(const Node<Dim>& node, Scratch& scratch, EquationWriter<Dim>& write) const {
    const FluxProblem<Dim>& balance = *flux_problem(problem_);
    scratch.governing.at(node.id);
    problem_.governing(node.place(), scratch.governing.write);
    scratch.boundary.at(node.id);
    problem_.boundary(node, scratch.boundary.write);
    for (int f = 0; f < fields_; ++f) {
      if (scratch.boundary.is_value(f) || !balance.has_flux(f)) {
        copy_row(scratch.boundary, f, write);
        continue;
      }
      double right_hand_side = 0;
      for (const BoundaryMark<Dim>& mark : node.marks) {
        if (balance.known(f, mark.side) == Known::value || is_mirrored(mark.side)) continue;
        balance.flux(f, node.place(), mark.normal, write);
        right_hand_side += balance.given(f, mark.side, node.x);
      }
      const double factor = -alpha_ * ghosts_.spacing[node.id];
      write.add_row(scratch.governing.list.row(f), factor);
      write.equals(right_hand_side + factor * scratch.governing.list.right_hand_sides[f],
                   factor * scratch.governing.list.inertia_of(f));
    }
  }

  bool is_mirrored(int side) const {
    return std::any_of(planes_.begin(), planes_.end(),
                       [side](const SymmetryPlane& plane) { return plane.side == side; });
  }

  /// Given values; the differential equations of the other fields.
  void write_beside_ghost(const Node<Dim>& node, Scratch& scratch,
                          EquationWriter<Dim>& write) const {
    fill(node, scratch);
    for (int f = 0; f < fields_; ++f) {
      copy_row(scratch.boundary.is_value(f) ? scratch.boundary : scratch.governing, f, write);
    }
  }

  /// What the node of a ghost has no room for.
  void write_ghost(int ghost, Scratch& scratch, EquationWriter<Dim>& write) const {
    const Node<Dim> node = node_of(cloud_, ghosts_.owners[ghost]);
    fill(node, scratch);
    scratch.ghost.at(node.id);
    problem_.ghost(node, scratch.ghost.write);
    for (int f = 0; f < fields_; ++f) {
      if (!scratch.boundary.is_value(f)) {
        copy_row(scratch.ghost, f, write);
      } else if (is_reversed(node, f)) {
        write.add_unknown(cloud_.size() + ghost, f, 1);
        write.equals(0);
      } else {
        // A given value has no acceleration, unless it changes in time.
        write.add_row(scratch.governing.list.row(f));
        write.equals(scratch.governing.list.right_hand_sides[f]);
      }
    }
  }

  void fill(const Node<Dim>& node, Scratch& scratch) const {
    scratch.governing.at(node.id);
    problem_.governing(node.place(), scratch.governing.write);
    scratch.boundary.at(node.id);
    problem_.boundary(node, scratch.boundary.write);
  }
};

/// Point collocation: the equation at each node, boundary conditions at boundary nodes. With a
/// method whose nodal parameters are not values, the value is a derivative like any other, and
/// every node has a stencil.
template <int Dim>
class Collocation final : public Form<Dim> {
 public:
  Collocation(Boundary boundary, Symmetry symmetry, double alpha)
      : boundary_(boundary), symmetry_(symmetry), alpha_(alpha) {}

  std::string unsupported(const SteadyProblem<Dim>& problem, const Method<Dim>&) const override {
    if (boundary_ == Boundary::plain || flux_problem(problem) != nullptr) return {};
    return "ghost and combined boundary rows take the flux of a problem, which this one does not "
           "state; boundary=plain can serve";
  }

  bool joins_parts() const override {
    return boundary_ == Boundary::plain && symmetry_ != Symmetry::images;
  }

  Plan<Dim> plan(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                 const Method<Dim>& method) const override {
    Plan<Dim> plan;
    plan.sites = sites_of_cloud<Dim>(cloud);
    plan.derivatives = derivatives_of(problem, cloud, method);
    const Symmetry by_default = boundary_ == Boundary::ghost ? Symmetry::images
                                : cloud.parts.empty()        ? Symmetry::by_default
                                                             : Symmetry::rows;
    const Symmetry wanted = symmetry_ == Symmetry::by_default ? by_default : symmetry_;
    const std::vector<SymmetryPlane> planes = mirrored_planes(problem, wanted);
    check_nodes_on_all_sides(problem.domain(), cloud, planes);
    skip_unread(problem, cloud, method, planes, plan.sites);
    Ghosts<Dim> ghosts;
    if (boundary_ != Boundary::plain || !planes.empty()) {
      const auto search = make_search<Dim>("auto", cloud.nodes);
      ghosts = prepared_ghosts(cloud, *search);
      if (boundary_ == Boundary::ghost) {
        place_ghosts(*flux_problem(problem), cloud, planes, plan.sites, ghosts);
      }
      plan.unknowns.count = plan.sites.node_count();
      append_images(planes, ghosts.spacing, plan.sites, plan.unknowns);
    } else {
      ghosts.of_node.assign(cloud.size(), -1);
      plan.unknowns.count = cloud.size();
    }
    plan.equations = CollocationRows<Dim>(problem, cloud, planes, std::move(ghosts),
                                          boundary_ == Boundary::combined ? alpha_ : 0.0);
    return plan;
  }

 private:
  Boundary boundary_;
  Symmetry symmetry_;
  double alpha_;

  Derivatives<Dim> derivatives_of(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                                  const Method<Dim>& method) const {
    Derivatives<Dim> all;
    if (!method.promises().interpolates) all.merge({MultiIndex<Dim>{}});
    if (boundary_ != Boundary::plain) all.merge(without_values(problem.derivatives({})));
    bool has_inner = false;
    for (int i = 0; i < cloud.size(); ++i) {
      const std::span<const BoundaryMark<Dim>> marks = cloud.marks_of(i);
      if (marks.empty() && has_inner) continue;  // the same for all
      has_inner = has_inner || marks.empty();
      all.merge(without_values(problem.derivatives(marks)));
    }
    if (!cloud.parts.empty()) {
      all.merge(without_values(interface_derivatives(interface_problem(problem))));
    }
    return all;
  }

  static Derivatives<Dim> without_values(const Derivatives<Dim>& derivatives) {
    return derivatives.without(MultiIndex<Dim>{});
  }

  /// Wants no stencil where nothing but the value is read.
  static void skip_unread(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                          const Method<Dim>& method, const std::vector<SymmetryPlane>& planes,
                          Sites<Dim>& sites) {
    if (!method.promises().interpolates || problem.measured_derivatives().size() > 0) return;
    const bool wants_inner = problem.derivatives({}).highest_order() > 0;
    for (int i = 0; i < cloud.size(); ++i) {
      const std::span<const BoundaryMark<Dim>> marks = cloud.marks_of(i);
      if (marks.empty() && wants_inner) continue;
      if (lies_on_planes_only<Dim>(marks, planes) || !cloud.twins_of(i).empty()) continue;
      if (problem.derivatives(marks).highest_order() == 0) sites.wanted[i] = 0;
    }
  }
};

}  // namespace

/// Point collocation. `ghost`: one node outside of each boundary node that has a condition on
/// derivatives, at the mean distance of its nearest neighbours; the differential equations hold at
/// the boundary node too. `combined`: condition - alpha h (differential equation); where sides
/// meet, the sum of their conditions. Source: the thesis' collocation is `plain`; Onate, Perazzo &
/// Miquel 2001 (finite point method, stabilised boundary) for `combined`.
FormEntry form_collocation() {
  return {{"collocation",
           "the equation at each node, boundary conditions at boundary nodes",
           {{"boundary", "plain",
             "plain | ghost | combined: conditions on derivatives replace the equation at their "
             "node, have a node outside of it, or are added to alpha h times the equation"},
            {"alpha", "0.25", "share of the equation in combined rows, 0.01 to 10"},
            {"symmetry", "default",
             "rows | images | default: symmetry planes are conditions at their nodes or mirrors; "
             "by default rows in 2D without ghosts, else images"}}},
          in_every_dimension<Form>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<Form<Dim>> {
                return std::make_unique<Collocation<Dim>>(
                    options.choice<Boundary>("boundary", {{"plain", Boundary::plain},
                                                          {"ghost", Boundary::ghost},
                                                          {"combined", Boundary::combined}}),
                    symmetry_choice(options), options.number("alpha", 0.01, 10));
              })};
}

}  // namespace strongpoint
