#include "problems/core/node_fill.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/boundary_steps.hpp"
#include "problems/core/curve_march.hpp"
#include "problems/core/random.hpp"

namespace strongpoint {
namespace {

/// Candidates per node: enough to leave no gap, as in the source (15 in the plane).
template <int Dim>
constexpr int candidate_count = Dim == 2 ? 15 : 40;
/// Times every node proposes candidates: a second round closes the gaps where fronts met.
constexpr int rounds = 2;
/// Nodes may be this much closer than wanted, against round-off at candidates exactly in place.
constexpr double slack = 1e-9;
/// Ends of pieces closer than this fraction of the spacing are one corner.
constexpr double corner_tolerance = 1e-6;
/// The same for nodes along rims, which two faces place with slightly different parameters.
constexpr double rim_tolerance = 0.1;
/// Nodes of a rim that only cuts a face are left out closer than this fraction of the spacing.
constexpr double crowded = 0.8;
/// Spacing of a front over the wanted one, so that a cloud has as many nodes as a grid: at 1 a
/// front holds 0.87 (2D) and 0.79 (3D) nodes per h^Dim, measured on the unit cube.
template <int Dim>
constexpr double packing = Dim == 2 ? 0.935 : 0.925;
/// Distance to the boundary below which no node is placed inside, as a fraction of the spacing.
constexpr double boundary_margin = 0.5;

/// Adds a node on a side, or the side to a node already within `tolerance`. Gives the node's id.
template <int Dim>
int add_shared(NodeSet<Dim>& set, const Point<Dim>& x, int side, double tolerance) {
  int id = set.nodes.find_within(x, tolerance);
  if (id < 0) {
    id = set.nodes.add(x);
    set.sides.emplace_back();
  }
  std::vector<int>& sides = set.sides[id];
  if (std::find(sides.begin(), sides.end(), side) == sides.end()) sides.push_back(side);
  return id;
}

/// Distance that a front of dimension `FrontDim` keeps at a position.
template <int FrontDim, int Dim>
double front_spacing(const SpacingFunction<Dim>& spacing, const Point<Dim>& x) {
  return packing<FrontDim> * checked_spacing(spacing, x);
}

/// Whether a candidate reached from p with a step is free of other nodes. The distance kept is the
/// smaller of the step and the spacing at the candidate: towards coarser regions the spacing there
/// would rule out the step itself.
template <int Dim>
bool is_free(const NodeSet<Dim>& set, const Point<Dim>& candidate, double step, double h) {
  return set.nodes.find_within(candidate, std::min(step, h) * (1 - slack)) < 0;
}

/// Adds the ends of a piece's edges.
template <int Dim>
void add_corners(NodeSet<Dim>& set, const BoundaryPiece<Dim>& piece,
                 const SpacingFunction<Dim>& spacing) {
  for (const auto& rim : rims<Dim>()) {
    for (double end : {0.0, 1.0}) {
      const Point<Dim> x = piece.map(rim(end));
      add_shared(set, x, piece.side, corner_tolerance * checked_spacing(spacing, x));
    }
  }
}

/// Adds the nodes along a piece's edges. Gives those nodes, ends included.
template <int Dim>
std::vector<FrontNode<Dim>> add_rims(NodeSet<Dim>& set, const BoundaryPiece<Dim>& piece,
                                     const SpacingFunction<Dim>& spacing) {
  std::vector<FrontNode<Dim>> placed;
  for (const auto& rim : rims<Dim>()) {
    const Curve<Dim> curve = [&](double t) { return piece.map(rim(t)); };
    for (double t : march(curve, spacing)) {
      placed.push_back({rim(t), curve(t)});
      add_shared(set, placed.back().x, piece.side, rim_tolerance * spacing(placed.back().x));
    }
  }
  return placed;
}

/// Leaves out nodes of rims that only cut a face into pieces (they lie on one side) where they
/// crowd nodes on the face's edge: rims may come into a corner at an acute angle. The rest keeps
/// its order.
NodeSet<3> without_crowded_rims(const NodeSet<3>& all, NodeSet<3> kept,
                                const SpacingFunction<3>& spacing) {
  NodeSet<3> edges = kept;
  const auto append = [&](NodeSet<3>& set, int i) {
    set.nodes.add(all.nodes[i]);
    set.sides.push_back(all.sides[i]);
  };
  for (int i = 0; i < all.nodes.size(); ++i) {
    if (all.sides[i].size() > 1) append(edges, i);
  }
  for (int i = 0; i < all.nodes.size(); ++i) {
    const Point<3>& x = all.nodes[i];
    const double reach = crowded * front_spacing<2>(spacing, x);
    const bool is_cut = all.sides[i].size() == 1;
    const bool is_close =
        is_cut && (edges.nodes.find_within(x, reach) >= 0 || kept.nodes.find_within(x, reach) >= 0);
    if (!is_close) append(kept, i);
  }
  return kept;
}

/// Fills the inside of a face by an advancing front that starts at the nodes of its rims.
void fill_face(const BoundaryPiece<3>& piece, std::vector<FrontNode<3>> front,
               const SpacingFunction<3>& spacing, std::mt19937_64& generator, NodeSet<3>& set) {
  constexpr int candidates = candidate_count<2>;
  for (std::size_t next = 0; next < front.size(); ++next) {
    const FrontNode<3> node = front[next];
    const double h = front_spacing<2>(spacing, node.x);
    // J = Q R: parameter steps R^-1 d of unit vectors d have unit length and their angles on the
    // face.
    const Eigen::Matrix<double, 3, 2> j = jacobian(piece, node.parameter);
    const Eigen::Matrix2d r =
        j.householderQr().matrixQR().topRows<2>().template triangularView<Eigen::Upper>();
    const double turn = uniform01(generator);
    if (std::abs(r(0, 0) * r(1, 1)) < 1e-8 * j.squaredNorm()) continue;  // a collapsed rim
    for (int k = 0; k < candidates; ++k) {
      const double angle = 2 * std::numbers::pi * (k + turn) / candidates;
      const Eigen::Vector2d unit =
          r.triangularView<Eigen::Upper>().solve(Eigen::Vector2d(std::cos(angle), std::sin(angle)));
      FrontNode<3> candidate;
      if (!step_on_face(piece, node, h * unit, h, candidate)) continue;
      const double step = 0.5 * (h + front_spacing<2>(spacing, candidate.x));
      if (!step_on_face(piece, node, step * unit, step, candidate)) continue;
      const double wanted = front_spacing<2>(spacing, candidate.x);
      if (rim_distance(piece, candidate) < boundary_margin * wanted) continue;
      if (!is_free(set, candidate.x, step * (1 - 1e-3), wanted)) continue;
      add_shared(set, candidate.x, piece.side, 0.0);
      front.push_back(candidate);
    }
  }
}

/// An empty set around the pieces of a boundary.
template <int Dim>
NodeSet<Dim> empty_set(const std::vector<BoundaryPiece<Dim>>& pieces) {
  Point<Dim> low = Point<Dim>::Constant(std::numeric_limits<double>::infinity());
  Point<Dim> high = -low;
  const auto include = [&](const Point<Dim>& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  };
  constexpr int samples = 8;
  for (const BoundaryPiece<Dim>& piece : pieces) {
    if constexpr (Dim == 1) {
      include(piece.map({}));
    } else {
      for (const auto& rim : rims<Dim>()) {
        for (int i = 0; i <= samples; ++i)
          include(piece.map(rim(static_cast<double>(i) / samples)));
      }
    }
  }
  return {PointTree<Dim>(low, high), {}};
}

/// `candidate_count` unit vectors, nearly equispaced and turned at random.
template <int Dim>
Points<Dim> directions(std::mt19937_64& generator) {
  constexpr int n = candidate_count<Dim>;
  Points<Dim> result(Dim, n);
  if constexpr (Dim == 2) {
    const double turn = uniform01(generator);
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * std::numbers::pi * (k + turn) / n;
      result.col(k) << std::cos(angle), std::sin(angle);
    }
  } else {
    for (int k = 0; k < n; ++k) {  // a Fibonacci lattice on the sphere
      const double z = 1 - (2.0 * k + 1) / n;
      const double angle = 2 * std::numbers::pi * k * std::numbers::phi;
      const double radius = std::sqrt(1 - z * z);
      result.col(k) << radius * std::cos(angle), radius * std::sin(angle), z;
    }
    // A uniform rotation from three uniform numbers (Shoemake 1992).
    const double u = uniform01(generator);
    const double a = 2 * std::numbers::pi * uniform01(generator);
    const double b = 2 * std::numbers::pi * uniform01(generator);
    const Eigen::Quaterniond turn(std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a),
                                  std::sqrt(1 - u) * std::cos(a), std::sqrt(u) * std::sin(b));
    result = turn.toRotationMatrix() * result;
  }
  return result;
}

/// Lets one node propose candidates around it.
template <int Dim>
void grow_around(int id, const Domain<Dim>& domain, const SpacingFunction<Dim>& spacing,
                 std::mt19937_64& generator, NodeSet<Dim>& set) {
  const Point<Dim> x = set.nodes[id];
  const double h = front_spacing<Dim>(spacing, x);
  const Points<Dim> around = directions<Dim>(generator);
  for (Eigen::Index k = 0; k < around.cols(); ++k) {
    const Point<Dim> far = x + h * around.col(k);
    if (domain.distance(far) >= 0) continue;
    const double step = 0.5 * (h + front_spacing<Dim>(spacing, far));
    const Point<Dim> candidate = x + step * around.col(k);
    const double inside = -domain.distance(candidate);
    if (!(inside > 0)) continue;
    const double wanted = front_spacing<Dim>(spacing, candidate);
    if (inside < boundary_margin * wanted || !is_free(set, candidate, step, wanted)) continue;
    set.nodes.add(candidate);
    set.sides.emplace_back();
  }
}

}  // namespace

template <int Dim>
NodeSet<Dim> fill_boundary(const Domain<Dim>& domain, const SpacingFunction<Dim>& spacing,
                           std::mt19937_64& generator) {
  const std::vector<BoundaryPiece<Dim>> pieces = domain.pieces();
  if (pieces.empty()) {
    throw SkipCase("the domain describes no boundary to place scattered nodes on");
  }
  NodeSet<Dim> set = empty_set(pieces);
  if constexpr (Dim == 1) {
    for (const auto& piece : pieces) add_shared(set, piece.map({}), piece.side, 0.0);
  } else {
    for (const auto& piece : pieces) add_corners(set, piece, spacing);
    std::vector<std::vector<FrontNode<Dim>>> fronts;
    fronts.reserve(pieces.size());
    for (const auto& piece : pieces) fronts.push_back(add_rims(set, piece, spacing));
    if constexpr (Dim == 3) {
      set = without_crowded_rims(set, empty_set(pieces), spacing);
      for (std::size_t p = 0; p < pieces.size(); ++p) {
        fill_face(pieces[p], std::move(fronts[p]), spacing, generator, set);
      }
    }
  }
  return set;
}

template <int Dim>
void fill_interior(const Domain<Dim>& domain, const SpacingFunction<Dim>& spacing,
                   std::mt19937_64& generator, NodeSet<Dim>& set) {
  if constexpr (Dim == 1) {
    std::vector<double> ends;
    ends.reserve(set.nodes.size());
    for (int i = 0; i < set.nodes.size(); ++i) ends.push_back(set.nodes[i][0]);
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 1; i < ends.size(); ++i) {
      if (domain.distance(Point<1>(0.5 * (ends[i - 1] + ends[i]))) >= 0) continue;
      const Curve<1> segment = [&](double t) {
        return Point<1>(ends[i - 1] + t * (ends[i] - ends[i - 1]));
      };
      const std::vector<double> parameters = march(segment, spacing);
      for (std::size_t k = 1; k + 1 < parameters.size(); ++k) {
        set.nodes.add(segment(parameters[k]));
        set.sides.emplace_back();
      }
    }
  } else {
    for (int round = 0; round < rounds; ++round) {
      for (int id = 0; id < set.nodes.size(); ++id) {
        grow_around(id, domain, spacing, generator, set);
      }
    }
  }
}

template <int Dim>
PointCloud<Dim> to_cloud(const Domain<Dim>& domain, const NodeSet<Dim>& set) {
  CloudBuilder<Dim> builder;
  for (int i = 0; i < set.nodes.size(); ++i) {
    builder.add(set.nodes[i], domain.marks(set.sides[i], set.nodes[i]));
  }
  return builder.finish(domain.measure());
}

template NodeSet<1> fill_boundary(const Domain<1>&, const SpacingFunction<1>&, std::mt19937_64&);
template NodeSet<2> fill_boundary(const Domain<2>&, const SpacingFunction<2>&, std::mt19937_64&);
template NodeSet<3> fill_boundary(const Domain<3>&, const SpacingFunction<3>&, std::mt19937_64&);
template void fill_interior(const Domain<1>&, const SpacingFunction<1>&, std::mt19937_64&,
                            NodeSet<1>&);
template void fill_interior(const Domain<2>&, const SpacingFunction<2>&, std::mt19937_64&,
                            NodeSet<2>&);
template void fill_interior(const Domain<3>&, const SpacingFunction<3>&, std::mt19937_64&,
                            NodeSet<3>&);
template PointCloud<1> to_cloud(const Domain<1>&, const NodeSet<1>&);
template PointCloud<2> to_cloud(const Domain<2>&, const NodeSet<2>&);
template PointCloud<3> to_cloud(const Domain<3>&, const NodeSet<3>&);

}  // namespace strongpoint
