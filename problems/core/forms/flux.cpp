#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/spacing.hpp"
#include "problems/core/cell_faces.hpp"
#include "problems/core/form.hpp"
#include "problems/core/mirror.hpp"
#include "problems/core/side_nodes.hpp"

namespace strongpoint {
namespace {

/// The value given to a field at a boundary node, by the first side that gives one.
template <int Dim>
const BoundaryMark<Dim>* value_mark(const FluxProblem<Dim>& problem, int field,
                                    std::span<const BoundaryMark<Dim>> marks) {
  for (const BoundaryMark<Dim>& mark : marks) {
    if (problem.has_flux(field) && problem.known(field, mark.side) == Known::value) return &mark;
  }
  return nullptr;
}

/// Whose weights give the flux through a face between two cells.
enum class FaceStencils {
  one,  ///< inside the node's of one cell, that inside beside the boundary; both cells' between two
        ///< nodes of the boundary, along which one alone would prefer a direction
  both  ///< the mean of both
};

/// A flux that rows read: through a share of a face, from the weights at an evaluation point.
template <int Dim>
struct FaceFlux {
  int point;
  Point<Dim> x;
  Point<Dim> area;  ///< outward from the cell whose row reads it
  int side;         ///< of the domain, -1 between cells
};

/// Balances of fluxes over the cells of nodes.
template <int Dim>
class CellBalances {
 public:
  /// Appends the evaluation points of all fluxes to the sites, each served by the stencil of one
  /// cell.
  CellBalances(const FluxProblem<Dim>& problem, const PointCloud<Dim>& cloud, CellFaces<Dim> faces,
               FaceStencils face_stencils, Sites<Dim>& sites)
      : problem_(problem),
        cloud_(cloud),
        faces_(std::move(faces)),
        face_stencils_(face_stencils),
        fields_(static_cast<int>(problem.fields().size())),
        fluxes_(cloud.size()) {
    std::vector<Point<Dim>> places, spans;
    for (int i = 0; i < cloud.size(); ++i) {
      const std::span<const FacePoint<Dim>> points = faces_.of(i);
      for (std::size_t p = 0; p < points.size(); ++p) {
        FacePoint<Dim> face = points[p];
        const double share = share_of(i, face);
        if (share == 0) continue;
        spans.push_back(Point<Dim>::Zero());
        if (is_pair(points.subspan(p))) {
          ++p;
          spans.back() = 0.5 * (points[p].x - face.x);
          face.x += spans.back();
          face.area += points[p].area;
        }
        const int point = sites.point_count() + static_cast<int>(places.size());
        places.push_back(face.x);
        sites.point_anchor.push_back(i);
        const Point<Dim> area = share * face.area;
        fluxes_[i].push_back({point, face.x, area, face.side});
        if (face.neighbour >= 0) fluxes_[face.neighbour].push_back({point, face.x, -area, -1});
      }
    }
    append_points(places, spans, sites);
  }

  /// True when some field has a balance at a node, and not a given value or an equation of its own.
  bool has_any_balance(int node) const {
    for (int f = 0; f < fields_; ++f) {
      if (has_balance(node, f)) return true;
    }
    return false;
  }

  EquationList operator()(const Derivatives<Dim>& derivatives) const {
    EquationList list, whole;
    EquationWriter<Dim> write(list, derivatives), write_whole(whole, derivatives);
    for (int i = 0; i < cloud_.size(); ++i) {
      const Node<Dim> node = node_of(cloud_, i);
      for (int f = 0; f < fields_; ++f) {
        if (const BoundaryMark<Dim>* mark = value_mark(problem_, f, node.marks)) {
          write.at(i);
          write.add(f, MultiIndex<Dim>{}, 1);
          write.equals(problem_.given(f, mark->side, node.x));
        } else if (!problem_.has_flux(f)) {
          whole.clear();
          write_whole.at(i);
          problem_.governing(node.place(), write_whole);
          write.add_row(whole.row(f));
          write.equals(whole.right_hand_sides[f], whole.inertia_of(f));
        } else {
          write_balance(node, f, write);
        }
      }
    }
    return list;
  }

 private:
  const FluxProblem<Dim>& problem_;
  const PointCloud<Dim>& cloud_;
  CellFaces<Dim> faces_;
  FaceStencils face_stencils_;
  int fields_;
  std::vector<std::vector<FaceFlux<Dim>>> fluxes_;  ///< by node

  bool has_balance(int node, int field) const {
    return problem_.has_flux(field) &&
           value_mark(problem_, field, cloud_.marks_of(node)) == nullptr;
  }

  /// Whether the first two of some points are those of a face between two cells, equal in area, so
  /// that the fluxes through them are the mean of both.
  bool is_pair(std::span<const FacePoint<Dim>> points) const {
    if (!problem_.has_even_flux() || points.size() < 2) return false;
    constexpr double round_off = 1e-12;
    const FacePoint<Dim>& a = points[0];
    const FacePoint<Dim>& b = points[1];
    return a.neighbour >= 0 && a.neighbour == b.neighbour &&
           (a.area - b.area).norm() <= round_off * a.area.norm();
  }

  static void append_points(std::span<const Point<Dim>> places, std::span<const Point<Dim>> spans,
                            Sites<Dim>& sites) {
    const int before = sites.point_count();
    const int after = before + static_cast<int>(places.size());
    sites.points.conservativeResize(Eigen::NoChange, after);
    sites.spans = Points<Dim>::Zero(Dim, after);
    for (int p = before; p < after; ++p) {
      sites.points.col(p) = places[p - before];
      sites.spans.col(p) = spans[p - before];
    }
    if (sites.spans.isZero(0)) sites.spans.resize(Dim, 0);
  }

  /// How much the stencil of a cell counts at a point of its boundary.
  double share_of(int node, const FacePoint<Dim>& face) const {
    if (face.side >= 0) {
      for (int f = 0; f < fields_; ++f) {
        if (has_balance(node, f) && problem_.known(f, face.side) == Known::value) return 1;
      }
      return 0;
    }
    const int other = face.neighbour;
    if (!has_any_balance(node) && !has_any_balance(other)) return 0;
    const bool on_boundary = cloud_.is_boundary(node);
    const bool beside_boundary = cloud_.is_boundary(other);
    if (face_stencils_ == FaceStencils::both || (on_boundary && beside_boundary)) return 0.5;
    if (on_boundary != beside_boundary) return on_boundary ? 0 : 1;
    return node < other ? 1 : 0;
  }

  /// Fluxes through the boundary of a cell = the source inside: div sigma = f, integrated.
  void write_balance(const Node<Dim>& node, int field, EquationWriter<Dim>& write) const {
    const std::span<const FacePoint<Dim>> boundary = faces_.of(node.id);
    double right_hand_side = integrate_over_cell<Dim>(node.x, boundary, [&](const Point<Dim>& x) {
      return problem_.source(field, {x, node.patch});
    });
    for (const FacePoint<Dim>& face : boundary) {
      if (face.side < 0 || problem_.known(field, face.side) == Known::value) continue;
      // Slivers beside curved sides in space may count as negative.
      const double along = face.area.dot(problem_.domain().normal(face.side, face.x));
      right_hand_side -=
          std::copysign(face.area.norm(), along) * problem_.given(field, face.side, face.x);
    }
    for (const FaceFlux<Dim>& flux : fluxes_[node.id]) {
      if (flux.side >= 0 && problem_.known(field, flux.side) == Known::flux) continue;
      write.at(flux.point);
      problem_.flux(field, {flux.x, node.patch}, flux.area, write);
    }
    const double inertia = problem_.inertia(field, node.place());  // lumped at the node
    write.equals(right_hand_side, inertia == 0 ? 0 : inertia * cell_measure<Dim>(node.x, boundary));
  }
};

/// Balances over Voronoi cells.
template <int Dim>
class FluxForm final : public Form<Dim> {
 public:
  FluxForm(int gauss, FaceStencils face_stencils, Symmetry symmetry)
      : gauss_(gauss), face_stencils_(face_stencils), symmetry_(symmetry) {}

  std::string unsupported(const SteadyProblem<Dim>& problem, const Method<Dim>&) const override {
    if (flux_problem(problem) != nullptr) return {};
    return "flux balances the flux of a problem, which this one does not state; collocation can "
           "serve";
  }

  Plan<Dim> plan(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                 const Method<Dim>& method) const override {
    const FluxProblem<Dim>& balance = *flux_problem(problem);
    const std::vector<SymmetryPlane> planes = mirrored_planes(problem, symmetry_);
    check_nodes_on_value_sides(balance, cloud, planes);
    const auto search = make_search<Dim>("auto", cloud.nodes);
    Plan<Dim> plan;
    plan.sites = sites_of_cloud<Dim>(cloud);
    CellBalances<Dim> rows(balance, cloud,
                           cell_faces<Dim>(cloud, problem.domain(), *search, gauss_),
                           face_stencils_, plan.sites);
    plan.derivatives = balance.flux_derivatives();
    if (!method.promises().interpolates) plan.derivatives.merge({MultiIndex<Dim>{}});
    want_what_is_read(balance, cloud, rows, plan);
    plan.unknowns.count = cloud.size();
    if (!planes.empty()) {
      append_images(planes, local_spacing<Dim>(cloud.nodes, cloud.nodes, *search), plan.sites,
                    plan.unknowns);
    }
    plan.equations = std::move(rows);
    return plan;
  }

 private:
  int gauss_;
  FaceStencils face_stencils_;
  Symmetry symmetry_;

  /// Wants no stencil where values are given, unless something else is read there. Adds the
  /// derivatives of equations that hold point by point.
  static void want_what_is_read(const FluxProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                                const CellBalances<Dim>& rows, Plan<Dim>& plan) {
    bool all_have_flux = true;
    for (int f = 0; f < static_cast<int>(problem.fields().size()); ++f) {
      all_have_flux = all_have_flux && problem.has_flux(f);
    }
    if (!all_have_flux) plan.derivatives.merge(problem.derivatives({}));
    const bool reads_all = problem.measured_derivatives().size() > 0 || !all_have_flux ||
                           plan.derivatives.contains(MultiIndex<Dim>{});
    if (reads_all) return;
    for (int i = 0; i < cloud.size(); ++i) {
      if (!rows.has_any_balance(i)) plan.sites.wanted[i] = 0;
    }
    for (int p = cloud.size(); p < plan.sites.point_count(); ++p) {
      plan.sites.wanted[plan.sites.point_anchor[p]] = 1;
    }
  }
};

}  // namespace

/// Flux balance over the nodes' Voronoi cells, clipped to the domain: the fluxes through a cell's
/// faces, from the derivatives at their Gauss points, and through the boundary, as given there,
/// add up to the source inside. Only first derivatives; no ghosts, no corner rules. Values given at
/// nodes are rows on these. A face takes the same stencils in the rows of both its cells, so that
/// fluxes are conserved; with one of its own in either row, second-order errors of displacements
/// are 60 times larger. Between two nodes of the boundary it takes both, as one alone prefers a
/// direction along it: with weights that are flat about the centre (mfpm, lsfdm) the error of
/// stresses on the plate was up to 150 times larger then, and waves grew. In time inertia is lumped
/// at nodes; take `faces=both` and hyperviscosity. Source: a finite-volume method with meshless
/// gradients, as Moroney & Turner 2006 (radial basis functions).
FormEntry form_flux() {
  return {{"flux",
           "fluxes balanced over each node's Voronoi cell, values at nodes",
           {{"gauss", "2", "Gauss points per face and direction, 1 to 4"},
            {"faces", "one",
             "one | both: the flux through a face from the stencil of one of its cells, or the "
             "mean of both: a third slower, steadier in time"},
            {"symmetry", "default",
             "rows | images | default: symmetry planes are sides like others or mirrors; by "
             "default rows in 2D, images in 3D"}}},
          in_every_dimension<Form>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<Form<Dim>> {
                return std::make_unique<FluxForm<Dim>>(
                    options.integer("gauss", 1, 4),
                    options.choice<FaceStencils>(
                        "faces", {{"one", FaceStencils::one}, {"both", FaceStencils::both}}),
                    symmetry_choice(options));
              })};
}

}  // namespace strongpoint
