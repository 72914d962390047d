#include "problems/core/line_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strongpoint {
namespace {

/// A place on the line and its distance beyond what counts as inside.
struct Place {
  double t, distance;

  bool is_inside() const { return distance <= 0; }
};

/// Of an interval that changes the distance by at least this fraction of its length the distance is
/// taken to be monotone: it cannot turn by more than what is left.
constexpr double monotone_change = 0.9;

template <int Dim>
class CrossingFinder {
 public:
  CrossingFinder(const Domain<Dim>& domain, const DistanceLine<Dim>& line, double resolution,
                 std::vector<double>& crossings)
      : domain_(domain),
        line_(line),
        length_((line.to - line.from).norm()),
        resolution_(resolution),
        round_off_(std::numeric_limits<double>::epsilon() *
                   std::max(line.from.cwiseAbs().maxCoeff(), length_)),
        crossings_(crossings) {}

  void search(const Place& low, const Place& high) {
    const double length = (high.t - low.t) * length_;
    const double change = std::abs(low.distance) + std::abs(high.distance);
    const bool crosses = low.is_inside() != high.is_inside();
    if (!crosses && change >= length) return;
    if (crosses && (change >= monotone_change * length || length <= resolution_)) {
      crossings_.push_back(root(low, high));
    } else if (length <= resolution_) {
      search_peak(low, high);
    } else {
      const Place middle = at(0.5 * (low.t + high.t));
      search(low, middle);
      search(middle, high);
    }
  }

 private:
  const Domain<Dim>& domain_;
  const DistanceLine<Dim>& line_;
  double length_, resolution_, round_off_;
  std::vector<double>& crossings_;

  Place at(double t) const {
    return {t, domain_.distance(line_.from + t * (line_.to - line_.from)) - line_.inside};
  }

  /// The root between two places on different sides: secants that stay in the bracket (the Illinois
  /// rule), and a bisection whenever two of them have not halved it.
  double root(Place low, Place high) const {
    constexpr int most_steps = 200;
    double weight_low = low.distance, weight_high = high.distance;
    int slow_steps = 0;
    for (int step = 0; step < most_steps; ++step) {
      const double width = high.t - low.t;
      double t = (low.t * weight_high - high.t * weight_low) / (weight_high - weight_low);
      if (!(t > low.t && t < high.t) || slow_steps == 2) {
        t = 0.5 * (low.t + high.t);
        slow_steps = 0;
      }
      if (!(t > low.t && t < high.t)) break;
      const Place next = at(t);
      if (std::abs(next.distance) <= round_off_) return t;
      if (next.is_inside() == low.is_inside()) {
        low = next;
        weight_low = next.distance;
        weight_high *= 0.5;
      } else {
        high = next;
        weight_high = next.distance;
        weight_low *= 0.5;
      }
      if (high.t - low.t > 0.5 * width) ++slow_steps;
    }
    return std::abs(low.distance) < std::abs(high.distance) ? low.t : high.t;
  }

  /// Looks for two crossings where the distance rises from both ends towards the boundary.
  void search_peak(Place low, Place high) {
    constexpr double golden = 0.3819660112501051;
    constexpr int most_steps = 40;
    constexpr double step = 1e-3;  // of the interval, to see the slopes at its ends
    const double sign = low.is_inside() ? 1 : -1;
    const double width = high.t - low.t;
    if (sign * (at(low.t + step * width).distance - low.distance) <= 0) return;
    if (sign * (at(high.t - step * width).distance - high.distance) <= 0) return;
    double a = low.t, b = high.t;
    Place first = at(a + golden * (b - a)), second = at(b - golden * (b - a));
    for (int i = 0; i < most_steps; ++i) {
      const Place& best = sign * first.distance > sign * second.distance ? first : second;
      if (best.is_inside() != low.is_inside()) {
        crossings_.push_back(root(low, best));
        crossings_.push_back(root(best, high));
        return;
      }
      if (&best == &first) {
        b = second.t;
        second = first;
        first = at(a + golden * (b - a));
      } else {
        a = first.t;
        first = second;
        second = at(b - golden * (b - a));
      }
    }
  }
};

}  // namespace

template <int Dim>
void find_crossings(const Domain<Dim>& domain, const DistanceLine<Dim>& line, double resolution,
                    std::vector<double>& crossings) {
  crossings.clear();
  CrossingFinder<Dim>(domain, line, resolution, crossings)
      .search({0, line.distance_from - line.inside}, {1, line.distance_to - line.inside});
}

template <int Dim>
std::optional<double> height_of_boundary(const Domain<Dim>& domain, const Point<Dim>& x,
                                         const Point<Dim>& up, double reach, double inside,
                                         std::vector<double>& scratch) {
  const double here = domain.distance(x);
  const double sign = here <= inside ? 1 : -1;
  // No crossing is nearer than the distance says.
  double step = std::max(1.1 * std::abs(here), 1e-3 * reach);
  while (step <= reach) {
    const Point<Dim> there = x + sign * step * up;
    const double beyond = domain.distance(there);
    if ((beyond <= inside) == (here <= inside)) {
      step *= 2;
      continue;
    }
    find_crossings<Dim>(domain, {x, there, here, beyond, inside},
                        std::numeric_limits<double>::infinity(), scratch);
    return sign * step * scratch.front();
  }
  return std::nullopt;
}

template std::optional<double> height_of_boundary<2>(const Domain<2>&, const Point<2>&,
                                                     const Point<2>&, double, double,
                                                     std::vector<double>&);
template std::optional<double> height_of_boundary<3>(const Domain<3>&, const Point<3>&,
                                                     const Point<3>&, double, double,
                                                     std::vector<double>&);
template void find_crossings<2>(const Domain<2>&, const DistanceLine<2>&, double,
                                std::vector<double>&);
template void find_crossings<3>(const Domain<3>&, const DistanceLine<3>&, double,
                                std::vector<double>&);

}  // namespace strongpoint
