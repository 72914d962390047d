#include "problems/core/boundary_arc.hpp"

#include <cmath>
#include <limits>

#include "problems/core/line_crossings.hpp"

namespace strongpoint {
namespace {

/// Deviations of the boundary, relative to the chord, up to which it is straight, and up to which a
/// polynomial follows it.
constexpr double straight_tolerance = 1e-12;
constexpr double curve_tolerance = 1e-11;

/// Halvings of a stretch at most: a corner that nobody announced is cut off at 2^-8 of the stretch.
constexpr int most_halvings = 8;

/// Where a polynomial is compared with the boundary: between its outermost points and in the
/// middle, where it is worst.
constexpr std::array<double, 2> checked_places{0.09, 0.5};

/// Where a chord is compared with the boundary.
constexpr std::array<double, 3> straight_places{0.21, 0.5, 0.83};

/// Value at t of the polynomial that is 1 at node `one` of a list and 0 at the others.
double lagrange(std::span<const double> nodes, std::size_t one, double t) {
  double value = 1;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i != one) value *= (t - nodes[i]) / (nodes[one] - nodes[i]);
  }
  return value;
}

/// Slope of the same polynomial at node `at`.
double lagrange_slope(std::span<const double> nodes, std::size_t one, std::size_t at) {
  double slope = 0;
  for (std::size_t left_out = 0; left_out < nodes.size(); ++left_out) {
    if (left_out == one) continue;
    double product = 1 / (nodes[one] - nodes[left_out]);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (i != one && i != left_out) product *= (nodes[at] - nodes[i]) / (nodes[one] - nodes[i]);
    }
    slope += product;
  }
  return slope;
}

}  // namespace

struct BoundaryArc::Chord {
  Point<2> from, along, normal;
  double length;

  Chord(const Point<2>& a, const Point<2>& b) : from(a), along(b - a), length(along.norm()) {
    normal = Point<2>(along[1], -along[0]) / length;
  }
  Point<2> at(double t, double height = 0) const { return from + t * along + height * normal; }
};

BoundaryArc::BoundaryArc(const Domain<2>& domain, int gauss)
    : domain_(domain), straight_(gauss_legendre(gauss)), curved_(gauss_legendre(curved_points)) {
  std::vector<double> nodes{0.0};
  nodes.insert(nodes.end(), curved_.at.begin(), curved_.at.end());
  nodes.push_back(1.0);
  for (std::size_t j = 0; j < curved_points; ++j) {
    for (std::size_t i = 0; i < curved_points; ++i) {
      derivative_[i][j] = lagrange_slope(nodes, j + 1, i + 1);
    }
    for (std::size_t i = 0; i < checked_places.size(); ++i) {
      between_[i][j] = lagrange(nodes, j + 1, checked_places[i]);
    }
  }
}

void BoundaryArc::trace(const Point<2>& from, const Point<2>& to, int depth,
                        std::vector<FacePoint<2>>& points) {
  const Chord chord(from, to);
  if (!(chord.length > tolerance(chord, 0))) return;
  if (is_straight(chord)) return add_straight(chord, points);
  Heights heights;
  if (follow(chord, heights)) return add_curved(chord, heights, points);
  if (depth == most_halvings) return add_straight(chord, points);
  const Point<2> x = middle(chord, depth);
  trace(from, x, depth + 1, points);
  trace(x, to, depth + 1, points);
}

/// A fraction of the chord, but no less than the round-off of distances.
double BoundaryArc::tolerance(const Chord& chord, double relative) const {
  constexpr double round_off = 16 * std::numeric_limits<double>::epsilon();
  const double largest = (centre_ + chord.from).cwiseAbs().maxCoeff() + chord.length;
  return relative * chord.length + round_off * largest;
}

bool BoundaryArc::is_straight(const Chord& chord) const {
  const double allowed = tolerance(chord, straight_tolerance);
  for (double t : straight_places) {
    if (!(std::abs(distance(chord.at(t))) <= allowed)) return false;
  }
  return true;
}

/// Height of the boundary above a place on the chord, where one leaves the domain upwards: by
/// secants, or by search when they find another boundary. Nothing within the chord's length fails.
std::optional<double> BoundaryArc::height(const Chord& chord, double t) {
  constexpr int most_steps = 30;
  const double enough = tolerance(chord, 0) / 4;
  double before = 0;
  double distance_before = distance(chord.at(t));
  double now = -distance_before;  // the distance grows along the normal
  for (int step = 0; step < most_steps && std::abs(now) <= chord.length; ++step) {
    const double distance_now = distance(chord.at(t, now));
    const double slope = (distance_now - distance_before) / (now - before);
    if (std::abs(distance_now) <= enough && !(slope <= 0)) return now;
    if (!(slope > 0)) break;
    before = now;
    distance_before = distance_now;
    now -= distance_now / slope;
  }
  return height_of_boundary<2>(domain_, centre_ + chord.at(t), chord.normal, chord.length, 0,
                               scratch_);
}

/// Finds the heights of a stretch; false when their polynomial leaves the boundary.
bool BoundaryArc::follow(const Chord& chord, Heights& heights) {
  for (std::size_t i = 0; i < curved_points; ++i) {
    const std::optional<double> found = height(chord, curved_.at[i]);
    if (!found) return false;
    heights[i] = *found;
  }
  const double allowed = tolerance(chord, curve_tolerance);
  for (std::size_t place = 0; place < checked_places.size(); ++place) {
    double between = 0;
    for (std::size_t j = 0; j < curved_points; ++j) between += between_[place][j] * heights[j];
    if (!(std::abs(distance(chord.at(checked_places[place], between))) <= allowed)) return false;
  }
  return true;
}

void BoundaryArc::add_straight(const Chord& chord, std::vector<FacePoint<2>>& points) const {
  for (int i = 0; i < straight_.size(); ++i) {
    points.push_back({centre_ + chord.at(straight_.at[i]),
                      straight_.weight[i] * chord.length * chord.normal, -1, -1});
  }
}

void BoundaryArc::add_curved(const Chord& chord, const Heights& heights,
                             std::vector<FacePoint<2>>& points) const {
  for (std::size_t i = 0; i < curved_points; ++i) {
    double slope = 0;
    for (std::size_t j = 0; j < curved_points; ++j) slope += derivative_[i][j] * heights[j];
    // The tangent is along + slope * normal; a quarter turn to the right makes it point outwards.
    const Point<2> area = chord.length * chord.normal - slope / chord.length * chord.along;
    points.push_back(
        {centre_ + chord.at(curved_.at[i], heights[i]), curved_.weight[i] * area, -1, -1});
  }
}

/// Where to split a stretch: at the centre when that is a node on it, else half-way.
Point<2> BoundaryArc::middle(const Chord& chord, int depth) {
  const double t = -chord.from.dot(chord.along) / (chord.length * chord.length);
  const double up = -chord.from.dot(chord.normal);
  constexpr double margin = 0.05;  // else the node is hardly better than an end
  if (depth == 0 && t > margin && t < 1 - margin && std::abs(up) < chord.length &&
      std::abs(distance(Point<2>::Zero())) <= tolerance(chord, straight_tolerance)) {
    return Point<2>::Zero();
  }
  return chord.at(0.5, height(chord, 0.5).value_or(0));
}

}  // namespace strongpoint
