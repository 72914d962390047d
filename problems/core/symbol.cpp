#include "problems/core/symbol.hpp"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

using Complex = std::complex<double>;
using ComplexMatrix = FieldMatrix<Complex>;

constexpr int most_fields = 3;

}  // namespace

template <int Dim>
ExactSymbol<Dim>::ExactSymbol(const SteadyProblem<Dim>& problem, const Place<Dim>& place)
    : fields_(static_cast<int>(problem.fields().size())) {
  const Derivatives<Dim> derivatives = problem.derivatives({});
  EquationList list;
  EquationWriter<Dim> write(list, derivatives);
  problem.governing(place, write);
  std::map<std::pair<MultiIndex<Dim>, std::pair<int, int>>, double> sums;
  for (int f = 0; f < fields_; ++f) {
    if (list.inertia_of(f) == 0 || fields_ > most_fields) {
      throw SkipCase(fmt::format(
          "equation {} has no inertia: the equations are not those of waves in displacements", f));
    }
    for (const Term& term : list.row(f)) {
      const MultiIndex<Dim> alpha =
          term.derivative == value_only ? MultiIndex<Dim>{} : derivatives[term.derivative];
      if (order_of<Dim>(alpha) != 2 && term.coefficient != 0) {
        throw SkipCase(
            fmt::format("the equations read {}: their waves have no speed of their own, to which a "
                        "method's could be compared",
                        name_of<Dim>(alpha)));
      }
      const double coefficient = term.coefficient / list.inertia_of(f);
      summands_.push_back({f, term.field, alpha, coefficient});
      sums[{alpha, {f, term.field}}] += coefficient;
    }
  }
  for (const auto& [key, sum] : sums) {
    const auto& [alpha, place_in] = key;
    const auto mirror = sums.find({alpha, {place_in.second, place_in.first}});
    constexpr double round_off = 1e-12;
    if (mirror == sums.end() || std::abs(mirror->second - sum) > round_off * std::abs(sum)) {
      throw SkipCase("the equations are not symmetric in the fields, as those of waves are");
    }
  }
}

template <int Dim>
FieldMatrix<double> ExactSymbol<Dim>::at(const Point<Dim>& xi) const {
  FieldMatrix<double> matrix = FieldMatrix<double>::Zero(fields_, fields_);
  for (const Summand& summand : summands_) {
    double product = -summand.coefficient;  // (-i)^2
    for (int c = 0; c < Dim; ++c) {
      for (int power = 0; power < summand.alpha[c]; ++power) product *= xi[c];
    }
    matrix(summand.row, summand.column) += product;
  }
  return matrix;
}

/// Entries of a node's rows by node, before they lie side by side.
template <int Dim>
struct NodeSymbol<Dim>::Entries {
  int fields;
  std::map<int, std::vector<double>> columns{};  ///< node -> (fields * fields + 1), the value last

  double& operator()(int node, int slot) {
    const auto size = static_cast<std::size_t>(fields) * fields + 1;
    return columns.try_emplace(node, size, 0.0).first->second[slot];
  }
  /// Adds factor times a derivative at a point.
  void add(const Weights& weights, int point, int derivative, double factor, int slot) {
    const std::span<const int> nodes = weights.nodes(point);
    if (nodes.empty()) {
      throw CaseError(
          fmt::format("a derivative is read at evaluation point {}, which has no "
                      "weights; its stencil was not asked for",
                      point));
    }
    const Eigen::Map<const Eigen::MatrixXd> row = weights.row(point);
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      (*this)(nodes[j], slot) += factor * row(derivative, static_cast<Eigen::Index>(j));
    }
  }
};

template <int Dim>
NodeSymbol<Dim>::NodeSymbol(const EquationList& equations, int first_row, int fields,
                            const Weights& weights, const Points<Dim>& nodes, int node,
                            int value_slot)
    : fields_(fields) {
  Entries entries{fields};
  for (int f = 0; f < fields; ++f) {
    const double inertia = equations.inertia_of(first_row + f);
    if (inertia == 0) {
      throw SkipCase(
          fmt::format("equation {} of node {} has no inertia, so that it moves no wave", f, node));
    }
    for (const Term& term : equations.row(first_row + f)) {
      const double factor = term.coefficient / inertia;
      const int slot = term.field * fields + f;
      if (term.derivative == value_only) {
        entries(term.point, slot) += factor;
      } else {
        entries.add(weights, term.point, term.derivative, factor, slot);
      }
    }
  }
  if (value_slot != value_only) entries.add(weights, node, value_slot, 1, fields * fields);
  const auto count = static_cast<Eigen::Index>(entries.columns.size());
  offsets_.resize(Dim, count);
  rows_.resize(static_cast<Eigen::Index>(fields) * fields, count);
  values_.resize(value_slot == value_only ? 0 : count);
  Eigen::Index at = 0;
  for (const auto& [other, column] : entries.columns) {
    offsets_.col(at) = nodes.col(other) - nodes.col(node);
    rows_.col(at) = Eigen::Map<const Eigen::VectorXd>(column.data(), rows_.rows());
    if (values_.size() > 0) values_[at] = column.back();
    ++at;
  }
  if (!rows_.allFinite() || !values_.allFinite()) {
    throw CaseError(fmt::format(
        "the rows of node {} hold a number that is not finite; check the problem's data and the "
        "stencil",
        node));
  }
  scale_ = rows_.rowwise().lpNorm<1>().maxCoeff();
}

template <int Dim>
std::optional<typename NodeSymbol<Dim>::Along> NodeSymbol<Dim>::along(
    const Point<Dim>& xi, const Point<Dim>& direction) const {
  Along result{ComplexMatrix::Zero(fields_, fields_), ComplexMatrix::Zero(fields_, fields_)};
  Complex value = 0;
  Complex value_slope = 0;
  for (Eigen::Index j = 0; j < offsets_.cols(); ++j) {
    const double phase = -xi.dot(offsets_.col(j));
    const Complex wave(std::cos(phase), std::sin(phase));
    const Complex change = Complex(0, -direction.dot(offsets_.col(j))) * wave;
    for (Eigen::Index entry = 0; entry < rows_.rows(); ++entry) {
      result.symbol(entry) += rows_(entry, j) * wave;
      result.slope(entry) += rows_(entry, j) * change;
    }
    if (values_.size() == 0) continue;
    value += values_[j] * wave;
    value_slope += values_[j] * change;
  }
  if (values_.size() == 0) return result;
  constexpr double round_off = 1e-12;
  if (std::abs(value) < round_off * values_.lpNorm<1>()) return std::nullopt;
  result.symbol /= value;
  result.slope = (result.slope - value_slope * result.symbol).eval() / value;
  return result;
}

template <int Dim>
std::optional<ComplexMatrix> NodeSymbol<Dim>::at(const Point<Dim>& xi) const {
  const std::optional<Along> here = along(xi, Point<Dim>::Zero());
  return here ? std::optional<ComplexMatrix>(here->symbol) : std::nullopt;
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same for each dimension */ \
  template class ExactSymbol<Dim>;                                     \
  template class NodeSymbol<Dim>
STRONGPOINT_INSTANTIATE(1);
STRONGPOINT_INSTANTIATE(2);
STRONGPOINT_INSTANTIATE(3);
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
