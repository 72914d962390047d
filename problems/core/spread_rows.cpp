#include "problems/core/spread_rows.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// Places of values one after the other.
struct InOrder {
  std::size_t count;
  std::size_t size() const { return count; }
  std::size_t operator[](std::size_t j) const { return j; }
};

/// values(p_j, f) += the derivatives of node j times the coefficients of field f, p_j being its
/// place.
template <int Fields, int Derivatives, class Places>
void add_weighted(const double* weights, Places places, const double* coefficients,
                  double* values) {
  double known[Fields * Derivatives];
  std::copy_n(coefficients, Fields * Derivatives, known);
  for (std::size_t j = 0; j < places.size(); ++j) {
    const auto place = static_cast<std::size_t>(places[j]);
    for (int f = 0; f < Fields; ++f) {
      double sum = values[place * Fields + f];
      for (int d = 0; d < Derivatives; ++d) sum += known[f * Derivatives + d] * weights[d];
      values[place * Fields + f] = sum;
    }
    weights += Derivatives;
  }
}

/// The same for any numbers of fields and derivatives.
template <class Places>
void add_all_weighted(int fields, int derivatives, const double* weights, Places places,
                      const double* coefficients, double* values) {
  if (fields == 2 && derivatives == 2) {
    return add_weighted<2, 2>(weights, places, coefficients, values);
  }
  if (fields == 1 && derivatives == 2) {
    return add_weighted<1, 2>(weights, places, coefficients, values);
  }
  if (fields == 3 && derivatives == 3) {
    return add_weighted<3, 3>(weights, places, coefficients, values);
  }
  for (std::size_t j = 0; j < places.size(); ++j) {
    const auto place = static_cast<std::size_t>(places[j]);
    for (int f = 0; f < fields; ++f) {
      for (int d = 0; d < derivatives; ++d) {
        values[place * fields + f] += coefficients[f * derivatives + d] * weights[d];
      }
    }
    weights += derivatives;
  }
}

}  // namespace

bool SpreadRowMaker::has_same_stencil(int a, int b) const {
  const std::span<const int> left = sources_.weights.nodes(a);
  const std::span<const int> right = sources_.weights.nodes(b);
  return std::equal(left.begin(), left.end(), right.begin(), right.end());
}

/// Splits a row into groups.
void SpreadRowMaker::read(int row) {
  const EquationPlace& place = sources_.equations.places[row];
  const Term* const terms = sources_.equations.terms.data() + place.first;
  groups_.clear();
  readings_.clear();
  for (int t = 0; t < place.count; ++t) {
    const Term& term = terms[t];
    const int point = place.point == own_points ? term.point : place.point;
    const bool is_value = term.derivative == value_only;
    const std::uint64_t field = std::uint64_t{1} << term.field;
    const bool goes_on =
        !groups_.empty() && groups_.back().is_value == is_value && readings_.back().point == point;
    if (goes_on && !is_value) {
      readings_.back().end = t + 1;
      groups_.back().fields |= field;
      continue;
    }
    if (!is_value && sources_.weights.nodes(point).empty()) {
      throw CaseError(
          fmt::format("a derivative is read at evaluation point {}, which has no weights; its "
                      "stencil was not asked for",
                      point));
    }
    const bool joins = !is_value && !groups_.empty() && !groups_.back().is_value &&
                       has_same_stencil(readings_.back().point, point);
    if (joins) {
      groups_.back().fields |= field;
    } else {
      groups_.push_back({point, field, is_value});
    }
    const auto begin = static_cast<std::size_t>(t);
    readings_.push_back({point, groups_.size() - 1, begin, begin + 1});
  }
}

/// Puts the columns of all groups into the set; returns how many there are.
std::int64_t SpreadRowMaker::insert_columns() {
  if (!set_.has_room()) {  // few systems have such rows
    const std::int64_t unknowns =
        static_cast<std::int64_t>(sources_.unknowns.count) * sources_.fields;
    set_.resize(unknowns);
    sums_.assign(unknowns, 0);
  }
  std::int64_t count = 0;
  for (const Group& group : groups_) {
    const std::span<const int> nodes = group.is_value ? std::span<const int>(&group.first, 1)
                                                      : sources_.weights.nodes(group.first);
    for (int f = 0; f < sources_.fields; ++f) {
      if ((group.fields >> f & 1U) == 0) continue;
      for (const int node : nodes) count += set_.insert(sources_.column(node, f));
    }
  }
  return count;
}

/// True when all groups are stencils whose nodes are unknowns with all their fields.
bool SpreadRowMaker::has_whole_nodes() const {
  const std::uint64_t every_field = ~std::uint64_t{0} >> (64 - sources_.fields);
  return sources_.unknowns.is_identity() &&
         std::all_of(groups_.begin(), groups_.end(), [=](const Group& group) {
           return !group.is_value && group.fields == every_field;
         });
}

std::int64_t SpreadRowMaker::count_nodes() {
  seen_.resize(sources_.unknowns.count, 0);
  ++stamp_;
  std::int64_t count = 0;
  for (const Group& group : groups_) {
    for (const int node : sources_.weights.nodes(group.first)) {
      count += seen_[node] == stamp_ ? 0 : 1;
      seen_[node] = stamp_;
    }
  }
  return count;
}

/// Lists the columns of whole nodes, and the places of each group's nodes among these.
void SpreadRowMaker::list_nodes() {
  if (!nodes_.has_room()) nodes_.resize(sources_.unknowns.count);
  place_.resize(sources_.unknowns.count);
  std::size_t all = 0;
  for (const Group& group : groups_) {
    const std::span<const int> nodes = sources_.weights.nodes(group.first);
    for (const int node : nodes) nodes_.insert(node);
    all += nodes.size();
  }
  columns_.clear();
  int count = 0;
  nodes_.drain([&](std::int64_t node) {
    place_[node] = count++;
    for (int f = 0; f < sources_.fields; ++f) columns_.push_back(node * sources_.fields + f);
  });
  places_.resize(all);
  int* next = places_.data();
  for (const Group& group : groups_) {
    for (const int node : sources_.weights.nodes(group.first)) *next++ = place_[node];
  }
}

/// Adds up a row of whole nodes.
void SpreadRowMaker::add_nodes(const Term* terms) {
  const Weights& weights = sources_.weights;
  const int fields = sources_.fields;
  const int derivatives = weights.per_entry;
  values_.assign(columns_.size(), 0.0);
  const int* places = places_.data();
  for (std::size_t r = 0; r < readings_.size(); ++r) {
    const Reading& reading = readings_[r];
    const std::size_t nodes = weights.nodes(reading.point).size();
    coefficients_.assign(static_cast<std::size_t>(fields) * derivatives, 0.0);
    for (std::size_t t = reading.begin; t < reading.end; ++t) {
      coefficients_[terms[t].field * derivatives + terms[t].derivative] += terms[t].coefficient;
    }
    add_all_weighted(fields, derivatives,
                     weights.values.data() + weights.offsets[reading.point] * derivatives,
                     std::span<const int>(places, nodes), coefficients_.data(), values_.data());
    const bool is_last = r + 1 == readings_.size() || readings_[r + 1].group != reading.group;
    if (is_last) places += nodes;
  }
}

std::int64_t SpreadRowMaker::count(int row) {
  read(row);
  if (known_count_ >= 0 && groups_ == known_groups_) return known_count_;
  if (has_whole_nodes()) {
    known_count_ = count_nodes() * sources_.fields;
  } else {
    known_count_ = insert_columns();
    set_.drain([](std::int64_t) {});
  }
  known_groups_ = groups_;
  has_columns_ = false;
  return known_count_;
}

/// Adds what a row reads of one group to its columns.
void SpreadRowMaker::add_group(std::size_t group, std::span<const Reading> readings,
                               const Term* terms) {
  const Weights& weights = sources_.weights;
  const NodeUnknowns& unknowns = sources_.unknowns;
  const int fields = sources_.fields;
  if (groups_[group].is_value) {
    const Term& term = terms[readings.front().begin];
    const int node = readings.front().point;
    sums_[sources_.column(node, term.field)] += unknowns.sign(node, term.field) * term.coefficient;
    return;
  }
  const int derivatives = weights.per_entry;
  const std::span<const int> nodes = weights.nodes(groups_[group].first);
  group_sums_.assign(nodes.size() * fields, 0.0);
  for (const Reading& reading : readings) {
    coefficients_.assign(static_cast<std::size_t>(fields) * derivatives, 0.0);
    for (std::size_t t = reading.begin; t < reading.end; ++t) {
      coefficients_[terms[t].field * derivatives + terms[t].derivative] += terms[t].coefficient;
    }
    add_all_weighted(fields, derivatives,
                     weights.values.data() + weights.offsets[reading.point] * derivatives,
                     InOrder{nodes.size()}, coefficients_.data(), group_sums_.data());
  }
  for (int f = 0; f < fields; ++f) {
    if ((groups_[group].fields >> f & 1U) == 0) continue;
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      sums_[sources_.column(nodes[j], f)] +=
          unknowns.sign(nodes[j], f) * group_sums_[j * fields + f];
    }
  }
}

void SpreadRowMaker::make(int row) {
  read(row);
  const bool is_whole = has_whole_nodes();
  if (!has_columns_ || groups_ != known_groups_) {
    if (is_whole) {
      list_nodes();
    } else {
      columns_.resize(insert_columns());
      std::int64_t* next = columns_.data();
      set_.drain([&](std::int64_t column) { *next++ = column; });
    }
    known_groups_ = groups_;
    known_count_ = static_cast<std::int64_t>(columns_.size());
    has_columns_ = true;
  }
  const Term* const terms = sources_.equations.terms.data() + sources_.equations.places[row].first;
  if (is_whole) return add_nodes(terms);
  for (std::size_t begin = 0; begin < readings_.size();) {
    std::size_t end = begin + 1;
    while (end < readings_.size() && readings_[end].group == readings_[begin].group) ++end;
    add_group(readings_[begin].group, std::span(readings_).subspan(begin, end - begin), terms);
    begin = end;
  }
  values_.resize(columns_.size());
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    values_[i] = sums_[columns_[i]];
    sums_[columns_[i]] = 0;
  }
}

}  // namespace strongpoint
