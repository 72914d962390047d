#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/neighbours.hpp"
#include "methods/core/spacing.hpp"
#include "problems/core/disc_quadrature.hpp"
#include "problems/core/flux_problem.hpp"
#include "problems/core/form.hpp"
#include "problems/core/side_nodes.hpp"

namespace strongpoint {
namespace {

/// A quartic spline of the distance, 1 at the centre, with value and slope zero at the radius.
/// Source: Atluri & Zhu 1998 (24).
struct TestFunction {
  Point<2> centre;
  double radius;

  double value(const Point<2>& x) const {
    const double t = (x - centre).norm() / radius;
    return 1 + t * t * (-6 + t * (8 - 3 * t));
  }
  Point<2> gradient(const Point<2>& x) const {
    const double t = (x - centre).norm() / radius;
    return -12 * (1 - t) * (1 - t) / (radius * radius) * (x - centre);
  }
};

/// What is the same for the rows of one node: its test function and the points it is integrated at.
struct TestDomain {
  TestFunction test;
  DiscRule rule;
  std::vector<std::uint8_t> fields;  ///< 1: the weak equation; 0: the value is given
};

bool gives_value(const FluxProblem<2>& problem, int field, int side) {
  return problem.known(field, side) == Known::value;
}

/// True when the unknown flux at a boundary point enters a row of the node: some of its fields has
/// a weak equation although its value is given there.
bool has_unknown_flux(const FluxProblem<2>& problem, const TestDomain& domain,
                      const EdgePoint& edge) {
  for (std::size_t field = 0; field < domain.fields.size(); ++field) {
    const bool is_weak = domain.fields[field] != 0;
    if (is_weak && gives_value(problem, static_cast<int>(field), edge.side)) return true;
  }
  return false;
}

/// Meshless local Petrov-Galerkin: for each node and field the weak equation over a disc.
class Mlpg {
 public:
  Mlpg(double radius, DiscCounts counts) : radius_(radius), counts_(counts) {}

  /// The test domains of all nodes.
  std::vector<TestDomain> domains(const FluxProblem<2>& problem, const PointCloud<2>& cloud) const {
    std::vector<TestDomain> all;
    all.reserve(cloud.size());
    const DiscQuadrature quadrature(problem.domain(), counts_);
    const auto search = make_search<2>("auto", cloud.nodes);
    const Eigen::VectorXd spacing = local_spacing<2>(cloud.nodes, cloud.nodes, *search);
    const std::size_t fields = problem.fields().size();
    for (int i = 0; i < cloud.size(); ++i) {
      const Point<2> x = cloud.nodes.col(i);
      const double radius = radius_ * spacing[i];
      TestDomain domain{{x, radius}, {}, std::vector<std::uint8_t>(fields, 1)};
      if (cloud.is_boundary(i)) {
        for (const BoundaryMark<2>& mark : cloud.marks_of(i)) {
          for (std::size_t f = 0; f < fields; ++f) {
            if (gives_value(problem, static_cast<int>(f), mark.side)) domain.fields[f] = 0;
          }
        }
        if (std::count(domain.fields.begin(), domain.fields.end(), 1) > 0) {
          domain.rule = quadrature.cut(x, radius);
        }
      } else {
        domain.test.radius = std::min(radius, -problem.domain().distance(x));
        if (!(domain.test.radius > 0)) {
          throw CaseError(fmt::format("node {} at {} has no boundary mark but is not inside",
                                      cloud.number_of(i), format_point(x)));
        }
        domain.rule = quadrature.whole(x, domain.test.radius);
      }
      all.push_back(std::move(domain));
    }
    return all;
  }

  static Sites<2> sites(const FluxProblem<2>& problem, const PointCloud<2>& cloud,
                        const Method<2>& method, const std::vector<TestDomain>& domains) {
    Sites<2> sites = sites_at_nodes<2>(cloud.nodes);
    const bool reads_nodes =
        !method.promises().interpolates || problem.measured_derivatives().size() > 0;
    if (!reads_nodes) std::fill(sites.wanted.begin(), sites.wanted.end(), 0);
    std::vector<Point<2>> gauss;
    for (int node = 0; node < cloud.size(); ++node) {
      const TestDomain& domain = domains[node];
      for (const AreaPoint& area : domain.rule.area) gauss.push_back(area.x);
      for (const EdgePoint& edge : domain.rule.edge) {
        if (has_unknown_flux(problem, domain, edge)) gauss.push_back(edge.x);
      }
      const Zone zone = cloud.is_boundary(node) ? Zone::boundary : Zone::interior;
      sites.anchor_zone[node] = zone;
      sites.anchor_zone.resize(cloud.size() + gauss.size(), zone);
    }
    add_anchors(sites, gauss);
    return sites;
  }

  static EquationList equations(const FluxProblem<2>& problem, const PointCloud<2>& cloud,
                                const Derivatives<2>& derivatives,
                                const std::vector<TestDomain>& domains) {
    EquationList list;
    EquationWriter<2> write(list, derivatives);
    int first_point = cloud.size();
    for (int node = 0; node < cloud.size(); ++node) {
      const TestDomain& domain = domains[node];
      for (std::size_t field = 0; field < domain.fields.size(); ++field) {
        const int f = static_cast<int>(field);
        if (domain.fields[field] != 0) {
          write_weak(problem, domain, f, first_point, write);
        } else {
          write_value(problem, cloud, node, f, write);
        }
      }
      first_point += static_cast<int>(domain.rule.area.size());
      for (const EdgePoint& edge : domain.rule.edge) {
        if (has_unknown_flux(problem, domain, edge)) ++first_point;
      }
    }
    return list;
  }

 private:
  double radius_;
  DiscCounts counts_;

  /// Appends an anchor, itself an evaluation point, at each Gauss point.
  static void add_anchors(Sites<2>& sites, const std::vector<Point<2>>& gauss) {
    const int nodes = sites.anchor_count();
    const int all = nodes + static_cast<int>(gauss.size());
    sites.anchors.conservativeResize(Eigen::NoChange, all);
    for (int a = nodes; a < all; ++a) {
      sites.anchors.col(a) = gauss[a - nodes];
      sites.point_anchor.push_back(a);
    }
    sites.points = sites.anchors;
    sites.anchor_node.resize(all, -1);
    sites.wanted.resize(all, 1);
  }

  static void write_value(const FluxProblem<2>& problem, const PointCloud<2>& cloud, int node,
                          int field, EquationWriter<2>& write) {
    const Point<2> x = cloud.nodes.col(node);
    write.at(node);
    write.add(field, {0, 0}, 1);
    for (const BoundaryMark<2>& mark : cloud.marks_of(node)) {
      if (gives_value(problem, field, mark.side)) {
        return write.equals(problem.given(field, mark.side, x));
      }
    }
  }

  /// Writes int sigma.grad v - int_(value given) v sigma.n = int_(flux given) v g - int v f, which
  /// is div sigma = f times v, integrated by parts; f has the inertia.
  static void write_weak(const FluxProblem<2>& problem, const TestDomain& domain, int field,
                         int point, EquationWriter<2>& write) {
    const TestFunction& v = domain.test;
    double right_hand_side = 0;
    double inertia = 0;  // lumped at the node
    for (const AreaPoint& area : domain.rule.area) {
      write.at(point++);
      problem.flux(field, {area.x}, area.weight * v.gradient(area.x), write);
      const double share = area.weight * v.value(area.x);
      right_hand_side -= share * problem.source(field, {area.x});
      inertia -= share * problem.inertia(field, {area.x});
    }
    for (const EdgePoint& edge : domain.rule.edge) {
      const double share = edge.weight * v.value(edge.x);
      if (!gives_value(problem, field, edge.side)) {
        right_hand_side += share * problem.given(field, edge.side, edge.x);
      } else {
        write.at(point);
        problem.flux(field, {edge.x}, -share * problem.domain().normal(edge.side, edge.x), write);
      }
      if (has_unknown_flux(problem, domain, edge)) ++point;
    }
    write.equals(right_hand_side, inertia);
  }
};

/// The form in the dimensions where it exists, and its refusal in the others.
template <int Dim>
class MlpgForm final : public Form<Dim> {
 public:
  explicit MlpgForm(Mlpg form) : form_(form) {}

  std::string unsupported(const SteadyProblem<Dim>& problem,
                          const Method<Dim>& method) const override {
    if constexpr (Dim != 2) {
      return fmt::format("mlpg is offered in 2D only, this problem is in {}D", Dim);
    } else {
      if (flux_problem(problem) == nullptr) {
        return "mlpg integrates the flux of a problem, which this one does not state";
      }
      if (const std::string field = field_without_flux(problem); !field.empty()) {
        return fmt::format("mlpg integrates fluxes, and the field {} has none; flux can serve",
                           field);
      }
      if (method.needs().centre) {
        return "mlpg evaluates derivatives at Gauss points, which are no nodes, and this method "
               "needs a node at the centre of each stencil; mls can serve";
      }
      return {};
    }
  }

  Plan<Dim> plan(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                 const Method<Dim>& method) const override {
    if constexpr (Dim != 2) {
      throw SkipCase(unsupported(problem, method));
    } else {
      const FluxProblem<2>& balance = *flux_problem(problem);
      check_nodes_on_value_sides(balance, cloud);
      std::vector<TestDomain> domains = form_.domains(balance, cloud);
      Plan<2> plan;
      plan.derivatives = balance.flux_derivatives();
      if (!method.promises().interpolates) plan.derivatives.merge({MultiIndex<2>{}});
      plan.sites = Mlpg::sites(balance, cloud, method, domains);
      plan.unknowns.count = cloud.size();
      plan.equations = [&balance, &cloud,
                        domains = std::move(domains)](const Derivatives<2>& derivatives) {
        return Mlpg::equations(balance, cloud, derivatives, domains);
      };
      return plan;
    }
  }

 private:
  Mlpg form_;
};

}  // namespace

/// Meshless local Petrov-Galerkin: div sigma = f is multiplied by a test function on a small disc
/// about each node, integrated by parts and evaluated by Gauss points, each with a stencil and
/// weights of its own. Discs of nodes inside shrink until they lie in the domain; those of boundary
/// nodes are cut. Source: Atluri & Zhu 1998 (Poisson), 2000 (elasticity); thesis 1.3.1. Deviations:
/// given values are rows at their nodes, not a penalty (so that no factor has to be chosen); the
/// shape functions are those of the method chosen, moving least squares there. Discs of 1.3
/// spacings overlap, which makes errors several times smaller than with 0.9. Shape functions of
/// degree 1 miss second order, even on a grid: the test functions do not add up to a constant,
/// and what the Laplacian of such a function errs by does not cancel. Wide supports (mls beyond 2.6
/// spacings) are erratic on irregular clouds.
FormEntry form_mlpg() {
  return {{"mlpg",
           "weak equations on a disc about each node (local Petrov-Galerkin), values at nodes",
           {{"radius", "1.3", "radius of the discs over the local spacing, 0.1 to 5"},
            {"radial", "6", "quadrature points along a disc's radius, 1 to 64"},
            {"angular", "12", "quadrature points around a disc, 3 to 256"}}},
          in_every_dimension<Form>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<Form<Dim>> {
                return std::make_unique<MlpgForm<Dim>>(
                    Mlpg(options.number("radius", 0.1, 5),
                         {options.integer("radial", 1, 64), options.integer("angular", 3, 256)}));
              })};
}

}  // namespace strongpoint
