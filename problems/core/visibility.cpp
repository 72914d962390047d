#include "problems/core/visibility.hpp"

#include <algorithm>

namespace strongpoint {
namespace {

/// Depth outside over length outside that still counts as grazing.
constexpr double grazing = 0.1;
/// The segment is halved this often where the boundary is near.
constexpr int halvings = 6;
/// Contact between the ends that is shorter than this part of the segment is a crossing.
constexpr double short_contact = 4.0 / (1 << halvings);
/// Difference quotients of the distance are taken over this part of the segment.
constexpr double difference_step = 1e-6;
/// Distances outside up to this part of the segment are round-off.
constexpr double round_off = 1e-12;
/// Length of an interval that is not halved again, as a part of the segment.
constexpr double leaf = 1.0 / (1 << halvings);

/// Places along a boundary are looked at a second time, from a little further inside.
enum class Line { given, shifted };

/// A walk from one end of a segment to the other by bisection. An interval whose middle is further
/// inside than half its length is inside; what cannot be shown to be inside at the last halving is
/// collected into contacts, each judged as a whole.
template <int Dim>
class Walk {
 public:
  Walk(const Domain<Dim>& domain, const Point<Dim>& a, const Point<Dim>& b, Line line)
      : domain_(domain), a_(a), step_(b - a), length_(step_.norm()), line_(line) {}

  bool stays_inside() {
    if (length_ == 0 || distance_at(0.5) <= -0.5 * length_) return true;
    visit(0, 1, halvings);
    end_contact();
    return !is_blocked_;
  }

 private:
  const Domain<Dim>& domain_;
  Point<Dim> a_, step_;
  double length_;
  Line line_;
  bool is_blocked_ = false;
  bool is_in_contact_ = false;      ///< the part [first_, last_] may be outside
  double first_ = 0, last_ = 0;     ///< of the contact
  double depth_ = 0;                ///< largest distance outside in the contact
  double out_ = 0, out_depth_ = 0;  ///< length and depth of the stretch just walked outside

  double distance_at(double t) const { return domain_.distance(a_ + t * step_); }

  void visit(double low, double high, int halvings_left) {
    if (is_blocked_) return;
    const double middle = 0.5 * (low + high);
    const double outside = distance_at(middle);
    if (outside <= -0.5 * (high - low) * length_) {
      end_contact();
    } else if (outside > grazing * length_) {
      is_blocked_ = true;
    } else if (halvings_left > 0) {
      visit(low, middle, halvings_left - 1);
      visit(middle, high, halvings_left - 1);
    } else {
      add_leaf(low, high, outside);
    }
  }

  void add_leaf(double low, double high, double outside) {
    if (!is_in_contact_) {
      first_ = low;
      depth_ = 0;
    }
    is_in_contact_ = true;
    last_ = high;
    depth_ = std::max(depth_, outside);
    if (outside <= round_off * length_) return end_stretch();
    out_ += (high - low) * length_;
    out_depth_ = std::max(out_depth_, outside);
  }

  /// An arc is shallow, a notch is deep.
  void end_stretch() {
    if (out_depth_ > grazing * out_) is_blocked_ = true;
    out_ = out_depth_ = 0;
  }

  void end_contact() {
    if (!is_in_contact_) return;
    is_in_contact_ = false;
    end_stretch();
    if (is_blocked_) return;
    const bool is_at_end = first_ == 0 || last_ == 1;
    const bool is_short = last_ - first_ < short_contact;
    is_blocked_ = !is_at_end && (is_short || line_ == Line::shifted);
    if (line_ == Line::shifted || is_blocked_) return;
    is_blocked_ = goes_through() || (!is_short && passes_a_slit());
  }

  /// Whether the contact begins on the way to one face and ends on the way from another that looks
  /// the other way: a slit, crossed next to an end or at an angle that makes it as shallow as an
  /// arc.
  bool goes_through() const {
    const double noise = round_off * length_;
    const bool goes_out = distance_at(first_ + difference_step) > distance_at(first_) + noise;
    const bool comes_in = distance_at(last_ - difference_step) > distance_at(last_) + noise;
    return goes_out && comes_in && gradient(first_).dot(gradient(last_)) < 0;
  }

  /// Whether something is met between the ends of the contact a little further inside: the mouth of
  /// a slit in the face is too narrow to be noticed along the face itself.
  bool passes_a_slit() const {
    const Point<Dim> towards = gradient(0.5 * (first_ + last_));
    if (!(towards.norm() > 0)) return false;
    const Point<Dim> shift = -(depth_ + leaf * length_) * towards.normalized();
    const Point<Dim> from = a_ + (first_ + leaf) * step_ + shift;
    const Point<Dim> to = a_ + (last_ - leaf) * step_ + shift;
    return !Walk(domain_, from, to, Line::shifted).stays_inside();
  }

  /// Gradient of the distance times a length.
  Point<Dim> gradient(double t) const {
    const Point<Dim> x = a_ + t * step_;
    Point<Dim> result;
    for (int c = 0; c < Dim; ++c) {
      const Point<Dim> step = difference_step * length_ * Point<Dim>::Unit(c);
      result[c] = domain_.distance(x + step) - domain_.distance(x - step);
    }
    return result;
  }
};

/// A place outside moved to the boundary, along the gradient of the distance.
template <int Dim>
Point<Dim> moved_inside(const Domain<Dim>& domain, const Point<Dim>& x, double length) {
  const double outside = domain.distance(x);
  if (outside <= round_off * length) return x;
  Point<Dim> gradient;
  for (int c = 0; c < Dim; ++c) {
    const Point<Dim> step = difference_step * length * Point<Dim>::Unit(c);
    gradient[c] = domain.distance(x + step) - domain.distance(x - step);
  }
  return gradient.norm() > 0 ? Point<Dim>(x - outside * gradient.normalized()) : x;
}

}  // namespace

template <int Dim>
bool sees(const Domain<Dim>& domain, const Point<Dim>& a, const Point<Dim>& b) {
  if (Walk<Dim>(domain, a, b, Line::given).stays_inside()) return true;
  const double length = (b - a).norm();
  const Point<Dim> from = moved_inside(domain, a, length);
  const Point<Dim> to = moved_inside(domain, b, length);
  return (from != a || to != b) && Walk<Dim>(domain, from, to, Line::given).stays_inside();
}

template <int Dim>
Sight<Dim> sight_in(const Domain<Dim>& domain) {
  return [&domain](const Point<Dim>& a, const Point<Dim>& b) { return sees(domain, a, b); };
}

template bool sees(const Domain<1>&, const Point<1>&, const Point<1>&);
template bool sees(const Domain<2>&, const Point<2>&, const Point<2>&);
template bool sees(const Domain<3>&, const Point<3>&, const Point<3>&);
template Sight<1> sight_in(const Domain<1>&);
template Sight<2> sight_in(const Domain<2>&);
template Sight<3> sight_in(const Domain<3>&);

}  // namespace strongpoint
