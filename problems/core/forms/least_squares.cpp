#include <cmath>

#include "problems/core/cell_faces.hpp"
#include "problems/core/form.hpp"
#include "problems/core/side_nodes.hpp"

namespace strongpoint {
namespace {

/// A point with rows of its own, served by the stencil of a node.
template <int Dim>
struct ExtraPoint {
  Point<Dim> x;
  int node;
  Point<Dim> normal;
  int side;  ///< -1 inside
};

/// Points between the nodes: inside, the point of each cell's faces farthest from its node, once
/// per face; on sides with known fluxes, the points of the cells' boundary.
template <int Dim>
std::vector<ExtraPoint<Dim>> points_between(const PointCloud<Dim>& cloud,
                                            const CellFaces<Dim>& faces) {
  std::vector<ExtraPoint<Dim>> extra;
  std::vector<int> chosen(cloud.size(), -1);  // neighbour across the face taken
  for (int i = 0; i < cloud.size(); ++i) {
    const FacePoint<Dim>* farthest = nullptr;
    double reach = 0;
    for (const FacePoint<Dim>& face : faces.of(i)) {
      if (face.side >= 0) {
        extra.push_back({face.x, i, face.area.normalized(), face.side});
        continue;
      }
      const double distance = (face.x - cloud.nodes.col(i)).norm();
      if (distance <= reach) continue;
      reach = distance;
      farthest = &face;
    }
    if (farthest == nullptr) continue;
    chosen[i] = farthest->neighbour;
    if (chosen[i] < i && chosen[chosen[i]] == i) continue;  // taken from the other side
    extra.push_back({farthest->x, i, Point<Dim>::Zero(), -1});
  }
  return extra;
}

/// How much rows count, beside conditions on fluxes.
struct RowWeights {
  double equations, values;
};

/// The rows of an overdetermined system.
template <int Dim>
class LeastSquaresRows {
 public:
  LeastSquaresRows(const FluxProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                   std::vector<ExtraPoint<Dim>> extra, RowWeights weights)
      : problem_(problem),
        cloud_(cloud),
        extra_(std::move(extra)),
        weights_(weights),
        fields_(static_cast<int>(problem.fields().size())) {}

  EquationList operator()(const Derivatives<Dim>& derivatives) const {
    EquationList list;
    EquationWriter<Dim> write(list, derivatives);
    for (int i = 0; i < cloud_.size(); ++i) {
      const Node<Dim> node = node_of(cloud_, i);
      write.at(i);
      problem_.governing(node.place(), write);
      list.row_weights.resize(list.size(), weights_.equations);
      if (!node.marks.empty()) problem_.boundary(node, write);
      for (int row = static_cast<int>(list.row_weights.size()); row < list.size(); ++row) {
        list.row_weights.push_back(write.is_value(list.row(row)) ? weights_.values : 1.0);
      }
    }
    for (std::size_t e = 0; e < extra_.size(); ++e) {
      write.at(cloud_.size() + static_cast<int>(e));
      write_between(extra_[e], write);
      list.row_weights.resize(list.size(), extra_[e].side < 0 ? weights_.equations : 1.0);
    }
    return list;
  }

 private:
  const FluxProblem<Dim>& problem_;
  const PointCloud<Dim>& cloud_;
  std::vector<ExtraPoint<Dim>> extra_;
  RowWeights weights_;
  int fields_;

  void write_between(const ExtraPoint<Dim>& point, EquationWriter<Dim>& write) const {
    const Place<Dim> place{point.x, cloud_.patch_of(point.node), cloud_.spacing()};
    if (point.side < 0) return problem_.governing(place, write);
    for (int f = 0; f < fields_; ++f) {
      if (!problem_.has_flux(f) || problem_.known(f, point.side) == Known::value) continue;
      problem_.flux(f, place, point.normal, write);
      write.equals(problem_.given(f, point.side, point.x));
    }
  }
};

/// More equations than unknowns.
template <int Dim>
class LeastSquares final : public Form<Dim> {
 public:
  explicit LeastSquares(RowWeights weights) : weights_(weights) {}

  std::string unsupported(const SteadyProblem<Dim>& problem, const Method<Dim>&) const override {
    if (flux_problem(problem) != nullptr) return {};
    return "least_squares takes the flux of a problem along its sides, which this one does not "
           "state; collocation can serve";
  }

  Plan<Dim> plan(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                 const Method<Dim>& method) const override {
    const FluxProblem<Dim>& balance = *flux_problem(problem);
    check_nodes_on_all_sides(problem.domain(), cloud);
    const auto search = make_search<Dim>("auto", cloud.nodes);
    std::vector<ExtraPoint<Dim>> extra =
        points_between(cloud, cell_faces<Dim>(cloud, problem.domain(), *search, 1));
    Plan<Dim> plan;
    plan.derivatives = problem.derivatives({});
    plan.derivatives.merge(balance.flux_derivatives());
    if (!method.promises().interpolates) plan.derivatives.merge({MultiIndex<Dim>{}});
    plan.sites = sites_of_cloud<Dim>(cloud);
    plan.sites.points.conservativeResize(Eigen::NoChange,
                                         cloud.size() + static_cast<int>(extra.size()));
    for (std::size_t e = 0; e < extra.size(); ++e) {
      plan.sites.points.col(cloud.size() + static_cast<int>(e)) = extra[e].x;
      plan.sites.point_anchor.push_back(extra[e].node);
    }
    plan.unknowns.count = cloud.size();
    plan.equations = LeastSquaresRows<Dim>(balance, cloud, std::move(extra), weights_);
    return plan;
  }

 private:
  RowWeights weights_;
};

}  // namespace

/// Least squares: the differential equations at all nodes and at one more point in most cells, the
/// conditions at boundary nodes and between them. Rows are scaled to a largest entry of 1, so that
/// differential equations count about h times as much as tractions, then weighted: 3 is best on the
/// plate (10 doubles the error, 30 multiplies it by twenty). Solve with `spqr` or `normal`. Good
/// where the solution is smooth, wrong where it has no second derivatives in L2 (Cook's corners).
/// Source: Zhang, Liu, Song & Lu 2001 (least-squares collocation).
FormEntry form_least_squares() {
  return {{"least_squares",
           "more equations than unknowns: at the nodes and between them; --solver spqr or normal",
           {{"equations", "3", "weight of the differential equations, 1e-3 to 1e3"},
            {"values", "10", "weight of rows that give a value, 1 to 1e6"}}},
          in_every_dimension<Form>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<Form<Dim>> {
                return std::make_unique<LeastSquares<Dim>>(RowWeights{
                    options.number("equations", 1e-3, 1e3), options.number("values", 1, 1e6)});
              })};
}

}  // namespace strongpoint
