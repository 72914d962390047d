#include "problems/core/assembly_rows.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace strongpoint {
namespace {

/// Numbers that are compared side by side.
constexpr int lanes = 16;

/// The rank of each number, by counting the smaller ones: no branch depends on the data.
template <int Blocks>
void sort_few(int count, const int* ids, int* order) {
  constexpr int width = Blocks * lanes;
  int rank[width] = {};
  for (int j = 0; j < count; ++j) {
    const int id = ids[j];
    for (int i = 0; i < width; ++i) rank[i] += ids[i] > id ? 1 : 0;
  }
  for (int i = 0; i < count; ++i) order[rank[i]] = i;
}

/// Entries of one field at all nodes of a stencil, `step` apart: sums of as many parts as named.
template <int Parts>
void sum_parts(const RowRecipe::Part* parts, const double* weights,
               std::span<const std::int64_t> entries, int step, double* values) {
  for (const std::int64_t entry : entries) {
    double sum = parts[0].coefficient * weights[entry + parts[0].derivative];
    for (int p = 1; p < Parts; ++p) {
      sum += parts[p].coefficient * weights[entry + parts[p].derivative];
    }
    *values = sum;
    values += step;
  }
}

/// The same for any number of parts.
void sum_all_parts(std::span<const RowRecipe::Part> parts, const double* weights,
                   std::span<const std::int64_t> entries, int step, double* values) {
  switch (parts.size()) {
    case 1:
      return sum_parts<1>(parts.data(), weights, entries, step, values);
    case 2:
      return sum_parts<2>(parts.data(), weights, entries, step, values);
    case 3:
      return sum_parts<3>(parts.data(), weights, entries, step, values);
    default:
      break;
  }
  for (const std::int64_t entry : entries) {
    double sum = 0;
    for (const RowRecipe::Part& part : parts) {
      sum += part.coefficient * weights[entry + part.derivative];
    }
    *values = sum;
    values += step;
  }
}

}  // namespace

void sort_positions(int count, int* ids, int* order) {
  const int padded = (count + lanes - 1) / lanes * lanes;
  std::fill(ids + count, ids + padded, std::numeric_limits<int>::max());
  switch (padded / lanes) {
    case 0:
      return;
    case 1:
      return sort_few<1>(count, ids, order);
    case 2:
      return sort_few<2>(count, ids, order);
    case 3:
      return sort_few<3>(count, ids, order);
    case 4:
      return sort_few<4>(count, ids, order);
    default:
      std::iota(order, order + count, 0);
      std::sort(order, order + count, [ids](int a, int b) { return ids[a] < ids[b]; });
  }
}

/// True when the nodes in a point's row are unknowns themselves.
bool RowMaker::has_plain_nodes(int point) {
  if (sources_.unknowns.is_identity()) return true;
  if (judged_point_ != point) {
    const std::span<const int> nodes = sources_.weights.nodes(point);
    judged_point_ = point;
    is_plain_ = std::all_of(nodes.begin(), nodes.end(),
                            [&](int node) { return sources_.unknowns.of(node) == node; });
  }
  return is_plain_;
}

/// True when the row is derivatives of fields at one point, without bare values, and no two of its
/// nodes stand for one unknown.
bool RowMaker::is_compact(int row) {
  const EquationPlace& place = sources_.equations.places[row];
  if (place.point == own_points) return false;
  const Term* const terms = sources_.equations.terms.data() + place.first;
  for (int t = 0; t < place.count; ++t) {
    if (terms[t].derivative == value_only) return false;
  }
  return has_plain_nodes(place.point);
}

const RowRecipe& RowMaker::recipe_of(int row) {
  const EquationPlace& place = sources_.equations.places[row];
  Known& known = recipes_[row % sources_.fields];
  if (known.first == place.first) return known.recipe;
  known.first = place.first;
  RowRecipe& recipe = known.recipe;
  const int derivatives = sources_.weights.per_entry;
  coefficients_.assign(static_cast<std::size_t>(sources_.fields) * derivatives, 0.0);
  recipe.fields.clear();
  for (const Term& term : sources_.equations.row(row)) {
    coefficients_[term.field * derivatives + term.derivative] += term.coefficient;
    recipe.fields.push_back(term.field);
  }
  std::sort(recipe.fields.begin(), recipe.fields.end());
  recipe.fields.erase(std::unique(recipe.fields.begin(), recipe.fields.end()), recipe.fields.end());
  recipe.parts.resize(recipe.fields.size());
  for (std::size_t f = 0; f < recipe.fields.size(); ++f) {
    recipe.parts[f].clear();
    for (int d = 0; d < derivatives; ++d) {
      const double coefficient = coefficients_[recipe.fields[f] * derivatives + d];
      if (coefficient != 0) recipe.parts[f].push_back({d, coefficient});
    }
  }
  return recipe;
}

std::int64_t RowMaker::count(int row) {
  const EquationPlace& place = sources_.equations.places[row];
  if (place.count == 0) return 0;
  if (is_compact(row)) {
    const auto nodes = static_cast<std::int64_t>(sources_.weights.nodes(place.point).size());
    return static_cast<std::int64_t>(recipe_of(row).fields.size()) * nodes;
  }
  if (place.count == 1 && sources_.equations.terms[place.first].derivative == value_only) return 1;
  return spread_.count(row);
}

void RowMaker::make(int row) {
  const EquationPlace& place = sources_.equations.places[row];
  is_spread_ = false;
  if (place.count > 0 && is_compact(row)) return fill_compact(row);
  has_stencil_columns_ = false;
  columns_.clear();
  values_.clear();
  if (place.count == 0) return;
  const Term term = sources_.equations.row(row).front();
  if (place.count == 1 && term.derivative == value_only) return fill_value(term);
  is_spread_ = true;
  spread_.make(row);
}

void RowMaker::fill_value(const Term& term) {
  columns_.push_back(sources_.column(term.point, term.field));
  values_.push_back(sources_.unknowns.sign(term.point, term.field) * term.coefficient);
}

void RowMaker::sort_nodes(int point) {
  if (sorted_point_ == point) return;
  sorted_point_ = point;
  has_stencil_columns_ = false;
  const std::span<const int> nodes = sources_.weights.nodes(point);
  const auto count = static_cast<int>(nodes.size());
  ids_.resize(count + lanes);
  order_.resize(count + lanes);
  entries_.resize(count);
  std::copy(nodes.begin(), nodes.end(), ids_.begin());
  sort_positions(count, ids_.data(), order_.data());
  const std::int64_t first = sources_.weights.offsets[point];
  for (int j = 0; j < count; ++j) {
    entries_[j] = (first + order_[j]) * sources_.weights.per_entry;
  }
}

/// Fills a compact row: for every stencil node, by id, the fields that occur.
void RowMaker::fill_compact(int row) {
  const EquationPlace& place = sources_.equations.places[row];
  const RowRecipe& recipe = recipe_of(row);
  const auto step = static_cast<int>(recipe.fields.size());
  sort_nodes(place.point);
  values_.resize(entries_.size() * step);
  for (int f = 0; f < step; ++f) {
    sum_all_parts(recipe.parts[f], sources_.weights.values.data(), entries_, step,
                  values_.data() + f);
  }
  if (has_stencil_columns_ && column_fields_ == recipe.fields) return;
  has_stencil_columns_ = true;
  column_fields_ = recipe.fields;
  columns_.resize(values_.size());
  std::int64_t* column = columns_.data();
  for (std::size_t j = 0; j < entries_.size(); ++j) {
    const auto first = static_cast<std::int64_t>(ids_[order_[j]]) * sources_.fields;
    for (int f = 0; f < step; ++f) *column++ = first + recipe.fields[f];
  }
}

}  // namespace strongpoint
