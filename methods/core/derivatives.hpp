#pragma once

#include <array>
#include <initializer_list>
#include <string>
#include <vector>

namespace strongpoint {

/// A partial derivative: how often each coordinate is differentiated; all zero is the value itself.
template <int Dim>
using MultiIndex = std::array<int, Dim>;

/// Total order |alpha| of a derivative.
template <int Dim>
int order_of(const MultiIndex<Dim>& alpha) {
  int order = 0;
  for (int a : alpha) order += a;
  return order;
}

/// alpha! = product of the factorials of the components.
template <int Dim>
double factorial(const MultiIndex<Dim>& alpha) {
  double result = 1;
  for (int a : alpha) {
    for (int i = 2; i <= a; ++i) result *= i;
  }
  return result;
}

/// Short name: "value", "dx", "dxy", "dyyy".
template <int Dim>
std::string name_of(const MultiIndex<Dim>& alpha) {
  std::string name = "d";
  for (int c = 0; c < Dim; ++c) name.append(alpha[c], "xyz"[c]);
  return name == "d" ? "value" : name;
}

/// An ordered set of derivatives: the ones somebody asked for, and no others.
template <int Dim>
class Derivatives {
 public:
  Derivatives() = default;
  Derivatives(std::initializer_list<MultiIndex<Dim>> list);

  /// Every derivative of order `least` to `most`, by order, then x before y before z.
  static Derivatives between_orders(int least, int most);

  bool operator==(const Derivatives&) const = default;
  int size() const { return static_cast<int>(list_.size()); }
  const MultiIndex<Dim>& operator[](int i) const { return list_[i]; }
  auto begin() const { return list_.begin(); }
  auto end() const { return list_.end(); }

  bool contains(const MultiIndex<Dim>& alpha) const;
  /// Position of a derivative; throws std::logic_error when it was not declared.
  int index(const MultiIndex<Dim>& alpha) const;
  /// Appends those of `other` that are missing.
  void merge(const Derivatives& other);
  /// The same set without one derivative.
  Derivatives without(const MultiIndex<Dim>& alpha) const;
  /// Largest total order, 0 when empty.
  int highest_order() const;

 private:
  std::vector<MultiIndex<Dim>> list_;

  int find(const MultiIndex<Dim>& alpha) const;
};

extern template class Derivatives<1>;
extern template class Derivatives<2>;
extern template class Derivatives<3>;

}  // namespace strongpoint
