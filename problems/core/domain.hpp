#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "problems/core/point_cloud.hpp"

namespace strongpoint {

/// A smooth piece of the boundary, the image of [0,1]^(Dim-1); in 1D a single point.
template <int Dim>
struct BoundaryPiece {
  using Parameter = Eigen::Matrix<double, Dim - 1, 1>;
  int side;  ///< index into the domain's sides
  std::function<Point<Dim>(const Parameter&)>
      map;  ///< ends (1D edges, 2D rims) are shared with neighbours
};

/// A smooth image of the unit cube, one of those that make up a domain.
template <int Dim>
struct Block {
  std::function<Point<Dim>(const Point<Dim>&)> map;  ///< from [0,1]^Dim, smooth up to the faces
  std::array<int, 2 * Dim> sides;  ///< side on each face, 2 c + end for x_c = end; the others are
                                   ///< `interface_side`
};

/// A corner, curve or face of a domain's boundary that nodes can be concentrated at.
template <int Dim>
struct Feature {
  std::string name;                                   ///< letters, digits and '_'
  std::function<double(const Point<Dim>&)> distance;  ///< from a point of the domain, not negative
};

/// The region a problem is posed on: a map from the unit cube for structured clouds, and a distance
/// function with boundary pieces for scattered ones.
template <int Dim>
class Domain {
 public:
  Domain() = default;
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;
  virtual ~Domain() = default;

  /// Names of the sides; physical groups and CSV tags are matched against them.
  virtual const std::vector<std::string>& sides() const = 0;
  /// Length, area or volume.
  virtual double measure() const = 0;
  /// Length of the side along which a level counts nodes.
  virtual double reference_length() const = 0;
  /// Image of a point of [0,1]^Dim. The last component varies fastest in the node order.
  virtual Point<Dim> map(const Point<Dim>& unit) const = 0;
  /// Sides that hold the image of a point on the boundary of the unit cube; several at a corner.
  virtual std::vector<int> sides_at(const Point<Dim>& unit) const = 0;
  /// Outward unit normal of a side at (or nearest to) x.
  virtual Point<Dim> normal(int side, const Point<Dim>& x) const = 0;
  /// Signed distance to the boundary, negative inside; exact near the boundary.
  virtual double distance(const Point<Dim>& x) const = 0;
  /// The boundary, piece by piece; pieces meet only at their ends.
  virtual std::vector<BoundaryPiece<Dim>> pieces() const = 0;
  /// Blocks that cover the domain, face to face, each with a smooth map: the image of the unit cube
  /// unless a domain's map has kinks. Throws SkipCase when there are none.
  virtual std::vector<Block<Dim>> blocks() const;
  /// Parts of the domain with data of their own, patch by patch, side indices being those of the
  /// whole; empty when there is one. Each gets a cloud by itself, and these have to meet node on
  /// node at the sides that are `interface_side`.
  virtual std::vector<const Domain*> patches() const { return {}; }
  /// Nodes along each axis of structured clouds of a level.
  virtual std::array<int, Dim> nodes_along(int level) const;
  /// Wanted distance between nodes of a scattered cloud of a level; uniform unless a problem grades
  /// it.
  virtual double spacing(const Point<Dim>& x, int level) const;
  /// Corners, curves and faces by name, for layouts that concentrate nodes; none unless the domain
  /// names some.
  virtual std::vector<Feature<Dim>> features() const { return {}; }
  /// The mesh file that the domain was made from, whose nodes serve as a cloud.
  virtual std::optional<std::string> own_mesh() const { return std::nullopt; }
  /// Boundary marks, with normals, of the sides given.
  std::vector<BoundaryMark<Dim>> marks(const std::vector<int>& sides, const Point<Dim>& x) const;
};

/// The box between the origin and a corner, with sides left, right (x), bottom, top (y), back,
/// front (z). A level counts nodes along x; structured clouds have about the same spacing along the
/// others.
template <int Dim>
class Box : public Domain<Dim> {
 public:
  /// Takes the lengths of the sides, all positive.
  explicit Box(const Point<Dim>& lengths) : lengths_(lengths) {}

  const std::vector<std::string>& sides() const override;
  double measure() const override { return lengths_.prod(); }
  double reference_length() const override { return lengths_[0]; }
  Point<Dim> map(const Point<Dim>& unit) const override { return unit.cwiseProduct(lengths_); }
  std::vector<int> sides_at(const Point<Dim>& unit) const override;
  Point<Dim> normal(int side, const Point<Dim>& x) const override;
  double distance(const Point<Dim>& x) const override;
  std::vector<BoundaryPiece<Dim>> pieces() const override;
  std::array<int, Dim> nodes_along(int level) const override;
  /// The sides, and `corners`.
  std::vector<Feature<Dim>> features() const override;

 private:
  Point<Dim> lengths_;
};

/// [0,1]^Dim.
template <int Dim>
class UnitCube : public Box<Dim> {
 public:
  UnitCube() : Box<Dim>(Point<Dim>::Ones()) {}
};

}  // namespace strongpoint
