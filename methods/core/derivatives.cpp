#include "methods/core/derivatives.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace strongpoint {
namespace {

/// Appends all multi-indices of one order whose components before `axis` are fixed.
template <int Dim>
void append_order(MultiIndex<Dim> alpha, int axis, int left, std::vector<MultiIndex<Dim>>& list) {
  if (axis == Dim - 1) {
    alpha[axis] = left;
    list.push_back(alpha);
    return;
  }
  for (int a = left; a >= 0; --a) {
    alpha[axis] = a;
    append_order<Dim>(alpha, axis + 1, left - a, list);
  }
}

}  // namespace

template <int Dim>
Derivatives<Dim>::Derivatives(std::initializer_list<MultiIndex<Dim>> list) {
  for (const MultiIndex<Dim>& alpha : list) {
    if (!contains(alpha)) list_.push_back(alpha);
  }
}

template <int Dim>
Derivatives<Dim> Derivatives<Dim>::between_orders(int least, int most) {
  Derivatives result;
  for (int order = least; order <= most; ++order) append_order<Dim>({}, 0, order, result.list_);
  return result;
}

template <int Dim>
int Derivatives<Dim>::find(const MultiIndex<Dim>& alpha) const {
  const auto place = std::find(list_.begin(), list_.end(), alpha);
  return place == list_.end() ? -1 : static_cast<int>(place - list_.begin());
}

template <int Dim>
bool Derivatives<Dim>::contains(const MultiIndex<Dim>& alpha) const {
  return find(alpha) >= 0;
}

template <int Dim>
int Derivatives<Dim>::index(const MultiIndex<Dim>& alpha) const {
  const int place = find(alpha);
  if (place < 0) {
    throw std::logic_error(
        fmt::format("derivative {} was not declared; add it to the derivatives asked for",
                    name_of<Dim>(alpha)));
  }
  return place;
}

template <int Dim>
void Derivatives<Dim>::merge(const Derivatives& other) {
  for (const MultiIndex<Dim>& alpha : other) {
    if (!contains(alpha)) list_.push_back(alpha);
  }
}

template <int Dim>
Derivatives<Dim> Derivatives<Dim>::without(const MultiIndex<Dim>& alpha) const {
  Derivatives result = *this;
  std::erase(result.list_, alpha);
  return result;
}

template <int Dim>
int Derivatives<Dim>::highest_order() const {
  int order = 0;
  for (const MultiIndex<Dim>& alpha : list_) order = std::max(order, order_of<Dim>(alpha));
  return order;
}

template class Derivatives<1>;
template class Derivatives<2>;
template class Derivatives<3>;

}  // namespace strongpoint
