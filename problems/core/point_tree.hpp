#pragma once

#include <array>
#include <vector>

#include "methods/core/points.hpp"

namespace strongpoint {

/// Points that arrive one by one and can be searched at any time: a 2^Dim-tree whose cells split
/// when they are full. Its cost follows the local density, so graded clouds are as fast as uniform
/// ones.
template <int Dim>
class PointTree {
 public:
  /// An empty tree around a box. Points may lie outside; the box only balances the tree.
  PointTree(const Point<Dim>& low, const Point<Dim>& high) {
    cells_.push_back({0.5 * (low + high), 0.25 * (high - low).maxCoeff()});
  }

  int size() const { return static_cast<int>(points_.size()); }
  const Point<Dim>& operator[](int id) const { return points_[id]; }

  /// Adds a point and gives its id, counted from 0.
  int add(const Point<Dim>& x) {
    points_.push_back(x);
    place(size() - 1);
    return size() - 1;
  }

  /// Id of some point closer to x than `radius`, -1 when there is none.
  int find_within(const Point<Dim>& x, double radius) const { return search(0, x, radius); }

 private:
  static constexpr int capacity = 8;
  static constexpr int children = 1 << Dim;
  /// Halving a cell more often is beyond the resolution of a double; deeper leaves just grow.
  static constexpr int deepest = 50;

  struct Cell {
    Point<Dim> centre;
    double quarter;        ///< distance from the centre to the children's, per coordinate
    int first_child = -1;  ///< -1: a leaf
    int depth = 0;
    std::vector<int> ids = {};  ///< of a leaf
  };

  std::vector<Point<Dim>> points_;
  std::vector<Cell> cells_;

  int child_of(int cell, const Point<Dim>& x) const {
    int child = 0;
    for (int c = 0; c < Dim; ++c) child |= (x[c] >= cells_[cell].centre[c] ? 1 : 0) << c;
    return cells_[cell].first_child + child;
  }

  void place(int id) {
    int cell = 0;
    while (cells_[cell].first_child >= 0) cell = child_of(cell, points_[id]);
    cells_[cell].ids.push_back(id);
    if (static_cast<int>(cells_[cell].ids.size()) > capacity && cells_[cell].depth < deepest) {
      split(cell);
    }
  }

  void split(int cell) {
    const Cell parent = cells_[cell];
    cells_[cell].first_child = static_cast<int>(cells_.size());
    cells_[cell].ids.clear();
    for (int child = 0; child < children; ++child) {
      Point<Dim> centre = parent.centre;
      for (int c = 0; c < Dim; ++c) {
        centre[c] += ((child >> c) & 1) != 0 ? parent.quarter : -parent.quarter;
      }
      cells_.push_back({centre, 0.5 * parent.quarter, -1, parent.depth + 1});
    }
    for (int id : parent.ids) cells_[child_of(cell, points_[id])].ids.push_back(id);
  }

  int search(int cell, const Point<Dim>& x, double radius) const {
    const Cell& here = cells_[cell];
    if (here.first_child < 0) {
      for (int id : here.ids) {
        if ((points_[id] - x).squaredNorm() < radius * radius) return id;
      }
      return -1;
    }
    for (int child = 0; child < children; ++child) {
      // Cells on the outside reach to infinity: only the planes through the centre separate.
      bool reached = true;
      for (int c = 0; c < Dim && reached; ++c) {
        const double beyond = x[c] - here.centre[c];
        reached = ((child >> c) & 1) != 0 ? beyond > -radius : beyond < radius;
      }
      if (!reached) continue;
      const int found = search(here.first_child + child, x, radius);
      if (found >= 0) return found;
    }
    return -1;
  }
};

}  // namespace strongpoint
