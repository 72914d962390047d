#include "problems/core/disc_quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace strongpoint {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;

Point<2> at(const BoundaryPiece<2>& piece, double t) {
  return piece.map(BoundaryPiece<2>::Parameter(t));
}

Point<2> direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Length of a piece along chords.
double chord_length(const BoundaryPiece<2>& piece) {
  constexpr int chords = 32;
  double length = 0;
  for (int i = 0; i < chords; ++i) {
    length += (at(piece, (i + 1.0) / chords) - at(piece, static_cast<double>(i) / chords)).norm();
  }
  return length;
}

/// Length of a piece per parameter at t, by differences of fourth order that stay on the piece.
double speed(const BoundaryPiece<2>& piece, double t) {
  const double step = std::min({1e-3, t / 2, (1 - t) / 2});
  const Point<2> near = at(piece, t + step) - at(piece, t - step);
  const Point<2> far = at(piece, t + 2 * step) - at(piece, t - 2 * step);
  return (8 * near - far).norm() / (12 * step);
}

/// Where the piece crosses the rim between two parameters on either side of it.
double crossing(const BoundaryPiece<2>& piece, const Point<2>& centre, double radius, double inside,
                double outside) {
  constexpr int halvings = 60;
  for (int i = 0; i < halvings; ++i) {
    const double middle = (inside + outside) / 2;
    ((at(piece, middle) - centre).norm() < radius ? inside : outside) = middle;
  }
  return (inside + outside) / 2;
}

/// The parameter nearest to the centre, where integrands in the distance have a kink.
double nearest(const BoundaryPiece<2>& piece, const Point<2>& centre, double from, double to) {
  constexpr int thirds = 80;
  for (int i = 0; i < thirds; ++i) {
    const double low = from + (to - from) / 3;
    const double high = to - (to - from) / 3;
    const bool is_low = (at(piece, low) - centre).norm() < (at(piece, high) - centre).norm();
    (is_low ? to : from) = is_low ? high : low;
  }
  return (from + to) / 2;
}

}  // namespace

DiscQuadrature::DiscQuadrature(const Domain<2>& domain, DiscCounts counts)
    : domain_(domain),
      counts_(counts),
      pieces_(domain.pieces()),
      radial_(gauss_legendre(counts.radial)) {
  for (const BoundaryPiece<2>& piece : pieces_) lengths_.push_back(chord_length(piece));
}

DiscRule DiscQuadrature::whole(const Point<2>& centre, double radius) const {
  DiscRule rule;
  const double step = full_turn / counts_.angular;
  for (int a = 0; a < counts_.angular; ++a) {
    const Point<2> ray = radius * direction((a + 0.5) * step);
    for (int i = 0; i < radial_.size(); ++i) {
      const double s = radial_.at[i];
      rule.area.push_back({centre + s * ray, radial_.weight[i] * s * radius * radius * step});
    }
  }
  return rule;
}

DiscRule DiscQuadrature::cut(const Point<2>& centre, double radius) const {
  std::vector<Stretch> stretches;
  std::vector<double> crossings;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    find_stretches(pieces_[p], lengths_[p], centre, radius, stretches, crossings);
  }
  const auto is_inside = [&](double angle) {
    return domain_.distance(centre + radius * direction(angle)) < 0;
  };
  if (stretches.empty()) return is_inside(0) ? whole(centre, radius) : DiscRule{};
  DiscRule rule;
  std::sort(crossings.begin(), crossings.end());
  for (std::size_t c = 0; c < crossings.size(); ++c) {
    const bool is_last = c + 1 == crossings.size();
    const double to = is_last ? crossings.front() + full_turn : crossings[c + 1];
    if (is_inside((crossings[c] + to) / 2)) add_arc(centre, radius, crossings[c], to, rule);
  }
  if (crossings.empty() && is_inside(0)) add_arc(centre, radius, 0, full_turn, rule);
  for (const Stretch& stretch : stretches) add_stretch(centre, radius, stretch, rule);
  return rule;
}

/// Gauss points that integrate as well over an arc as equidistant ones over the whole circle.
int DiscQuadrature::arc_points(double angle) const {
  return static_cast<int>(std::ceil(counts_.angular * angle / full_turn)) + 3;
}

/// Collects what of a piece lies in the disc, split at the point nearest to the centre, and the
/// angles at which it crosses the rim.
void DiscQuadrature::find_stretches(const BoundaryPiece<2>& piece, double length,
                                    const Point<2>& centre, double radius,
                                    std::vector<Stretch>& stretches,
                                    std::vector<double>& crossings) const {
  const int samples = std::max(16, static_cast<int>(std::ceil(8 * length / radius)));
  const auto cross = [&](double inside, double outside) {
    const double t = crossing(piece, centre, radius, inside, outside);
    const Point<2> ray = at(piece, t) - centre;
    crossings.push_back(std::atan2(ray[1], ray[0]));
    return t;
  };
  for (const double end : {0.0, 1.0}) {  // a corner on the rim counts whatever its round-off
    const Point<2> ray = at(piece, end) - centre;
    if (std::abs(ray.norm() - radius) < 1e-9 * radius) {
      crossings.push_back(std::atan2(ray[1], ray[0]));
    }
  }
  double before = 0;
  double begin = 0;
  bool was_inside = (at(piece, 0) - centre).norm() < radius;
  for (int i = 1; i <= samples; ++i) {
    const double t = static_cast<double>(i) / samples;
    const bool is_inside = (at(piece, t) - centre).norm() < radius;
    if (is_inside && !was_inside) begin = cross(t, before);
    const bool leaves = was_inside && !is_inside;
    if (leaves || (is_inside && i == samples)) {
      const double end = leaves ? cross(before, t) : t;
      const double middle = nearest(piece, centre, begin, end);
      stretches.push_back({&piece, begin, middle});
      stretches.push_back({&piece, middle, end});
    }
    was_inside = is_inside;
    before = t;
  }
}

void DiscQuadrature::add_arc(const Point<2>& centre, double radius, double from, double to,
                             DiscRule& rule) const {
  const LineRule arc = gauss_legendre(arc_points(to - from));
  for (int a = 0; a < arc.size(); ++a) {
    const Point<2> ray = radius * direction(from + (to - from) * arc.at[a]);
    const double share = arc.weight[a] * (to - from) * radius * radius;
    for (int i = 0; i < radial_.size(); ++i) {
      const double s = radial_.at[i];
      rule.area.push_back({centre + s * ray, radial_.weight[i] * s * share});
    }
  }
}

void DiscQuadrature::add_stretch(const Point<2>& centre, double radius, const Stretch& stretch,
                                 DiscRule& rule) const {
  constexpr double nothing = 1e-12;  // of the radius: round-off of a flat piece through the centre
  const double span = stretch.to - stretch.from;
  if (span < nothing) return;
  const double chord = (at(*stretch.piece, stretch.to) - at(*stretch.piece, stretch.from)).norm();
  const LineRule along = gauss_legendre(std::max(counts_.radial, arc_points(chord / radius)));
  for (int a = 0; a < along.size(); ++a) {
    const double t = stretch.from + span * along.at[a];
    const Point<2> y = at(*stretch.piece, t);
    const double length = along.weight[a] * span * speed(*stretch.piece, t);
    rule.edge.push_back({y, length, stretch.piece->side});
    const double reach = (y - centre).dot(domain_.normal(stretch.piece->side, y));
    if (std::abs(reach) < nothing * radius) continue;
    for (int i = 0; i < radial_.size(); ++i) {
      const double s = radial_.at[i];
      rule.area.push_back({centre + s * (y - centre), radial_.weight[i] * s * reach * length});
    }
  }
}

}  // namespace strongpoint
