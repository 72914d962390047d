#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/fornberg.hpp"
#include "problems/core/form.hpp"
#include "problems/core/gauss_legendre.hpp"

namespace strongpoint {
namespace {

/// A face of a block through a node: what the node's share of the face's integral is taken with.
template <int Dim>
struct FaceShare {
  int side;          ///< of the domain, or `interface_side`
  Point<Dim> along;  ///< outward normal times the share of the face's measure
};

/// What a node stands for in its block's quadrature.
template <int Dim>
struct NodeShare {
  double measure = 0;                                  ///< weight times the Jacobian's determinant
  std::vector<std::pair<int, Point<Dim>>> divergence;  ///< nodes of the lines through it: a flux is
                                                       ///< taken along these and added up
  std::vector<FaceShare<Dim>> faces;
};

/// The parts of a cloud, of which there is one where it names none.
template <int Dim>
std::vector<Part<Dim>> parts_of(const PointCloud<Dim>& cloud) {
  if (!cloud.parts.empty()) return cloud.parts;
  return {{0, cloud.size(), 0, cloud.block}};
}

/// The quadrature rule of a part's lines. Throws SkipCase when they do not lie at its points.
template <int Dim>
LineRule rule_of(const Part<Dim>& part, int axis) {
  constexpr double tolerance = 1e-12;  // of coordinates in [0,1]
  if (part.block && part.block->axes[axis].size() >= 3) {
    const std::vector<double>& at = part.block->axes[axis];
    LineRule rule = gauss_lobatto(static_cast<int>(at.size()));
    const auto is_near = [&](double a, double b) { return std::abs(a - b) < tolerance; };
    if (std::equal(at.begin(), at.end(), rule.at.begin(), is_near)) return rule;
  }
  throw SkipCase(
      "the form gll needs blocks of 3 Gauss-Lobatto points a side at least: blocks[nodes=gll]");
}

/// Quadrature and metric terms of one part. Metric terms are differences of the nodes' own
/// coordinates over whole lines, as the weights of a spectral method are.
template <int Dim>
class PartQuadrature {
 public:
  PartQuadrature(const PointCloud<Dim>& cloud, const Part<Dim>& part)
      : cloud_(cloud), first_(part.first) {
    for (int c = 0; c < Dim; ++c) {
      rules_[c] = rule_of(part, c);
      const std::vector<double>& at = rules_[c].at;
      slopes_[c].resize(rules_[c].size(), rules_[c].size());
      for (int i = 0; i < rules_[c].size(); ++i) {
        slopes_[c].row(i) = fornberg_weights(at, at[i], 1).row(1);
      }
    }
    std::array<int, Dim> middle;
    for (int c = 0; c < Dim; ++c) middle[c] = rules_[c].size() / 2;
    for (int face = 0; face < 2 * Dim; ++face) {
      std::array<int, Dim> index = middle;
      index[face / 2] = face % 2 == 0 ? 0 : rules_[face / 2].size() - 1;
      sides_[face] = cloud.all_marks_of(node_at(index)).front().side;
    }
  }

  NodeShare<Dim> share_of(int node) const {
    const std::array<int, Dim> index = index_of(node);
    const Matrix jacobian = jacobian_at(node, index);
    const double scale = std::abs(jacobian.determinant());
    const Matrix gradients = jacobian.inverse();
    NodeShare<Dim> share{scale, {}, {}};
    int stride = 1;
    for (int c = Dim - 1; c >= 0; --c) {
      share.measure *= rules_[c].weight[index[c]];
      for (int i = 0; i < rules_[c].size(); ++i) {
        share.divergence.emplace_back(node + (i - index[c]) * stride,
                                      slopes_[c](index[c], i) * gradients.row(c).transpose());
      }
      stride *= rules_[c].size();
    }
    for (int face = 0; face < 2 * Dim; ++face) {
      const int axis = face / 2;
      if (index[axis] != (face % 2 == 0 ? 0 : rules_[axis].size() - 1)) continue;
      double area = face % 2 == 0 ? -scale : scale;
      for (int c = 0; c < Dim; ++c) area *= c == axis ? 1 : rules_[c].weight[index[c]];
      share.faces.push_back({sides_[face], area * gradients.row(axis).transpose()});
    }
    return share;
  }

 private:
  using Matrix = Eigen::Matrix<double, Dim, Dim>;

  const PointCloud<Dim>& cloud_;
  int first_;
  std::array<LineRule, Dim> rules_;
  std::array<Eigen::MatrixXd, Dim> slopes_;  ///< (n, n) first derivative along a line
  std::array<int, 2 * Dim> sides_{};         ///< of the block's faces

  int node_at(const std::array<int, Dim>& index) const {
    int node = 0;
    for (int c = 0; c < Dim; ++c) node = node * rules_[c].size() + index[c];
    return first_ + node;
  }
  std::array<int, Dim> index_of(int node) const {
    std::array<int, Dim> index;
    int rest = node - first_;
    for (int c = Dim - 1; c >= 0; --c) {
      index[c] = rest % rules_[c].size();
      rest /= rules_[c].size();
    }
    return index;
  }
  Matrix jacobian_at(int node, const std::array<int, Dim>& index) const {
    Matrix jacobian = Matrix::Zero();
    int stride = 1;
    for (int c = Dim - 1; c >= 0; --c) {
      for (int i = 0; i < rules_[c].size(); ++i) {
        jacobian.col(c) +=
            slopes_[c](index[c], i) * cloud_.nodes.col(node + (i - index[c]) * stride);
      }
      stride *= rules_[c].size();
    }
    return jacobian;
  }
};

/// The rows of all unknowns.
template <int Dim>
class GllRows {
 public:
  GllRows(const FluxProblem<Dim>& problem, const PointCloud<Dim>& cloud,
          const NodeUnknowns& unknowns)
      : problem_(problem), cloud_(cloud), members_(unknowns.count) {
    for (int n = 0; n < cloud.size(); ++n) members_[unknowns.of(n)].push_back(n);
    shares_.reserve(cloud.size());
    for (const Part<Dim>& part : parts_of(cloud)) {
      const PartQuadrature<Dim> quadrature(cloud, part);
      for (int n = part.first; n < part.first + part.count; ++n) {
        shares_.push_back(quadrature.share_of(n));
      }
    }
  }

  EquationList operator()(const Derivatives<Dim>& derivatives) const {
    EquationList list;
    EquationWriter<Dim> write(list, derivatives);
    const int fields = static_cast<int>(problem_.fields().size());
    for (const std::vector<int>& nodes : members_) {
      for (int f = 0; f < fields; ++f) write_row(nodes, f, write);
    }
    return list;
  }

 private:
  const FluxProblem<Dim>& problem_;
  const PointCloud<Dim>& cloud_;
  std::vector<std::vector<int>> members_;  ///< (unknowns) the nodes that share each
  std::vector<NodeShare<Dim>> shares_;     ///< (N)

  /// A given value, or the sum over the blocks of -(measure) (div - source - inertia u'') + faces'
  /// (flux - given).
  void write_row(const std::vector<int>& nodes, int field, EquationWriter<Dim>& write) const {
    double right_hand_side = 0;
    double inertia = 0;
    for (int node : nodes) {
      for (const BoundaryMark<Dim>& mark : cloud_.marks_of(node)) {
        if (problem_.known(field, mark.side) != Known::value) continue;
        write.at(node);
        write.add(field, MultiIndex<Dim>{}, 1);
        write.equals(problem_.given(field, mark.side, cloud_.nodes.col(node)));
        return;
      }
    }
    for (int node : nodes) {
      const NodeShare<Dim>& share = shares_[node];
      const Place<Dim> place = node_of(cloud_, node).place();
      for (const auto& [other, along] : share.divergence) {
        write.at(other);
        problem_.flux(field, node_of(cloud_, other).place(), -share.measure * along, write);
      }
      right_hand_side -= share.measure * problem_.source(field, place);
      inertia -= share.measure * problem_.inertia(field, place);
      write.at(node);
      for (const FaceShare<Dim>& face : share.faces) {
        problem_.flux(field, place, face.along, write);
        if (face.side == interface_side) continue;
        right_hand_side += face.along.norm() * problem_.given(field, face.side, place.x);
      }
    }
    write.equals(right_hand_side, inertia);
  }
};

/// Rows weighted by the quadrature of the blocks, one unknown for all nodes at a place.
template <int Dim>
class Gll final : public Form<Dim> {
 public:
  std::string unsupported(const SteadyProblem<Dim>& problem,
                          const Method<Dim>& method) const override {
    if (!method.needs().block) {
      return "the form gll takes differences along the lines of blocks; take "
             "fdm[order=spectral,exact=mapped]";
    }
    const std::string field = field_without_flux(problem);
    if (field.empty()) return {};
    return fmt::format("the form gll integrates fluxes, and the field {} has none", field);
  }
  bool joins_parts() const override { return true; }

  Plan<Dim> plan(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                 const Method<Dim>&) const override {
    Plan<Dim> plan;
    plan.sites = sites_of_cloud<Dim>(cloud);
    plan.derivatives = flux_problem(problem)->flux_derivatives().without(MultiIndex<Dim>{});
    plan.unknowns.source.assign(cloud.size(), -1);
    for (int n = 0; n < cloud.size(); ++n) {
      if (plan.unknowns.source[n] >= 0) continue;
      plan.unknowns.source[n] = plan.unknowns.count;
      for (int twin : cloud.twins_of(n)) plan.unknowns.source[twin] = plan.unknowns.count;
      ++plan.unknowns.count;
    }
    plan.equations = GllRows<Dim>(*flux_problem(problem), cloud, plan.unknowns);
    return plan;
  }
};

}  // namespace

/// Weak rows by quadrature at the nodes of blocks: with weights w and Jacobian J the row of a node
/// is the sum over its blocks of -w_i w_j J (div sigma - f), the divergence being that of the
/// fluxes at the nodes of its lines, plus the sum over their faces at the node of w (sigma n -
/// given). On straight blocks and with differences over whole lines this is Galerkin's method with
/// Gauss-Lobatto quadrature: corners take no rule, interfaces balance by themselves.
/// Source: Patera 1984, spectral elements, in collocated form.
FormEntry form_gll() {
  return {
      {"gll", "equations and fluxes weighted by Gauss-Lobatto quadrature on blocks", {}},
      in_every_dimension<Form>([]<int Dim>(Dimension<Dim>, Options&) -> std::unique_ptr<Form<Dim>> {
        return std::make_unique<Gll<Dim>>();
      })};
}

}  // namespace strongpoint
