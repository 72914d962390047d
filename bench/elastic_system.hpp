#pragma once

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "methods/core/neighbours.hpp"
#include "methods/core/registry.hpp"
#include "problems/core/assembly.hpp"
#include "problems/core/domain.hpp"
#include "problems/core/elasticity.hpp"
#include "problems/core/layout.hpp"

namespace strongpoint {

/// A linear system with its solution.
struct KnownSystem {
  LinearSystem system;
  Eigen::VectorXd solution;
};

/// Which faces of the unit cube carry tractions; the others are fixed.
enum class Loaded { none, first_upper_face, upper_faces };

/// What an elastic system is made of.
struct ElasticChoices {
  int level = 11;  ///< nodes a side
  std::string method = "lsfdm[weight=power[p=4]]";
  std::string stencil = "nearest[k=35]";
  Loaded loaded = Loaded::upper_faces;
};

/// Displacement equations of an elastic unit cube (a square in 2D), nu = 0.3, by collocation on a
/// perturbed grid. A node on a face x_i = 1 has the equilibrium as its own equations, and the
/// traction across the mean normal of its faces as those of a ghost one spacing outside. The
/// right-hand side is that of a smooth field.
template <int Dim>
class ElasticSystem {
 public:
  explicit ElasticSystem(const ElasticChoices& choices)
      : choices_(choices),
        cloud_(make_cloud<Dim>(UnitCube<Dim>(), "perturbed[amount=0.2,seed=1]",
                               {.level = choices.level})) {
    place_ghosts();
  }

  /// Assembles the system. Throws as the method does.
  KnownSystem assembled() const {
    const auto method = make_method<Dim>(choices_.method).made;
    const auto search = make_search<Dim>("auto", nodes_);
    Sites<Dim> sites = sites_at_nodes<Dim>(Points<Dim>(cloud_.nodes));
    sites.nodes = nodes_;
    const Stencils stencils =
        select_stencils<Dim>(*make_rule<Dim>(choices_.stencil).made, sites, *method, *search);
    const Derivatives<Dim> derivatives = Derivatives<Dim>::between_orders(1, 2);
    const Weights weights = method->weights(sites, stencils, derivatives);
    const int nodes = static_cast<int>(nodes_.cols());
    KnownSystem made{assemble(equations(derivatives), weights, {.count = nodes}, Dim),
                     smooth_field()};
    multiply(made.system, made.solution, made.system.right_hand_side);
    made.system.dimension = Dim;
    made.system.field_axis.resize(Dim);
    std::iota(made.system.field_axis.begin(), made.system.field_axis.end(), 0);
    made.system.places = nodes_;
    made.system.order = order_along(nodes_.row(0).transpose());
    return made;
  }

 private:
  ElasticChoices choices_;
  PointCloud<Dim> cloud_;
  Points<Dim> nodes_;                ///< the cloud's and ghosts
  std::vector<int> loaded_;          ///< node of each ghost
  std::vector<Point<Dim>> normals_;  ///< of each ghost

  /// The mean normal where every side of a node is loaded, zero elsewhere.
  Point<Dim> load_normal(int node) const {
    Point<Dim> sum = Point<Dim>::Zero();
    for (const BoundaryMark<Dim>& mark : cloud_.marks_of(node)) {
      const bool is_upper = choices_.loaded == Loaded::first_upper_face ? mark.normal[0] > 0.5
                                                                        : mark.normal.sum() > 0;
      if (!is_upper || choices_.loaded == Loaded::none) return Point<Dim>::Zero();
      sum += mark.normal;
    }
    return sum.norm() > 0 ? Point<Dim>(sum.normalized()) : sum;
  }

  void place_ghosts() {
    for (int node = 0; node < cloud_.size(); ++node) {
      const Point<Dim> normal = load_normal(node);
      if (normal.norm() == 0) continue;
      loaded_.push_back(node);
      normals_.push_back(normal);
    }
    nodes_.resize(Dim, cloud_.size() + static_cast<int>(loaded_.size()));
    nodes_.leftCols(cloud_.size()) = cloud_.nodes;
    for (std::size_t g = 0; g < loaded_.size(); ++g) {
      nodes_.col(cloud_.size() + static_cast<int>(g)) =
          cloud_.nodes.col(loaded_[g]) + normals_[g] / (choices_.level - 1);
    }
  }

  EquationList equations(const Derivatives<Dim>& derivatives) const {
    const Lame material = lame_constants(1, 0.3);
    EquationList list;
    EquationWriter<Dim> write(list, derivatives);
    for (int node = 0; node < cloud_.size(); ++node) {
      write.at(node);
      const bool is_fixed = cloud_.is_boundary(node) && load_normal(node).norm() == 0;
      for (int i = 0; i < Dim; ++i) {
        if (is_fixed) {
          write.add(i, {}, 1);
        } else {
          add_equilibrium<Dim>(write, material, i);
        }
        write.equals(0);
      }
    }
    for (std::size_t g = 0; g < loaded_.size(); ++g) {
      write.at(loaded_[g]);
      for (int i = 0; i < Dim; ++i) {
        add_traction<Dim>(write, material, Point<Dim>::Unit(i), normals_[g]);
        write.equals(0);
      }
    }
    return list;
  }

  Eigen::VectorXd smooth_field() const {
    Eigen::VectorXd field(nodes_.size());
    for (int node = 0; node < nodes_.cols(); ++node) {
      for (int i = 0; i < Dim; ++i) {
        field[node * Dim + i] = std::sin(nodes_.col(node).sum() + 2 * nodes_(i, node) + i);
      }
    }
    return field;
  }

  static void multiply(const LinearSystem& system, const Eigen::VectorXd& x, Eigen::VectorXd& y) {
    for (std::int64_t row = 0; row < system.rows(); ++row) {
      y[row] = 0;
      for (std::int64_t i = system.offsets[row]; i < system.offsets[row + 1]; ++i) {
        y[row] += system.values[i] * x[system.columns[i]];
      }
    }
  }
};

}  // namespace strongpoint
