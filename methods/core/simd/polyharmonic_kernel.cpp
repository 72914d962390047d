#include "methods/core/simd/polyharmonic_kernel.hpp"

#include "methods/core/simd/polyharmonic_group.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// Smallest pivot of the projected matrix over its diagonal entry that is served here: far from
/// where the one by one path refuses (1e-14).
constexpr double definite_tolerance = 1e-11;

/// s^(1/2 + half).
Pack odd_power(Pack s, int half) {
  Pack value = sqrt(s);
  for (int k = 0; k < half; ++k) value = value * s;
  return value;
}

/// r^phs between node i and the nodes `begin` to `end`.
template <int Dim>
void fill_distances(const PolyharmonicTask& task, const PolyharmonicGroup& group, int i, int begin,
                    int end, Pack* values) {
  const int half = task.phs / 2;
  const Pack* const z = group.stencils.z;
  for (int j = begin; j < end; ++j) {
    Pack square = all(0);
    for (int c = 0; c < Dim; ++c) {
      const Pack along = z[i * Dim + c] - z[j * Dim + c];
      square = square + along * along;
    }
    values[j - begin] = odd_power(square, half);
  }
}

/// Projects r^phs onto the null space [-T^T; I] and factorises it there: with C = mixed - T chosen,
/// the projection is others - T mixed^T - C T^T. Gives the bits of lanes where it is safely
/// definite.
template <int Dim>
unsigned factorise_projected(const PolyharmonicTask& task, const PolyharmonicGroup& group) {
  const int n = task.table.size;
  const int m = task.terms;
  const int rest = n - m;
  for (int i = 0; i < m; ++i) {
    fill_distances<Dim>(task, group, i, 0, i + 1, &group.chosen(i, 0));
    for (int j = 0; j < i; ++j) group.chosen(j, i) = group.chosen(i, j);
  }
  for (int i = 0; i < rest; ++i) {
    fill_distances<Dim>(task, group, m + i, 0, m, &group.mixed(i, 0));
    fill_distances<Dim>(task, group, m + i, m, m + i + 1, &group.projected(i, 0));
    for (int j = 0; j < m; ++j) group.coupling(i, j) = group.mixed(i, j);
    for (int j = i + 1; j < rest && j < i + panel; ++j) group.projected(i, j) = all(0);
  }
  const LaneMatrix projection = group.polynomials.block(m, 0);
  solve_upper(m, group.polynomials.transposed(), nullptr, rest, projection.transposed());
  subtract_product(rest, m, group.coupling, projection, group.chosen, m);
  subtract_product_below(rest, group.projected, projection, group.mixed.transposed(), m);
  subtract_product_below(rest, group.projected, group.coupling, projection.transposed(), m);
  return factorise_definite(rest, group.projected, group.inverse_pivots, definite_tolerance);
}

/// Where derivatives are taken, about the anchor and over R: their means over one or two places.
template <int Dim>
struct Ends {
  Pack offsets[2][Dim];
  int count;
  double share;  ///< 1 / count
};

/// Right-hand sides of all derivatives at a point: of the polynomials, in columns `first` and
/// following.
template <int Dim>
void fill_constraints(const PolyharmonicTask& task, const PolyharmonicGroup& group,
                      const Ends<Dim>& ends, int first) {
  for (int d = 0; d < task.derivatives; ++d) {
    for (int a = 0; a < task.terms; ++a) {
      const double factor = task.factors[d * task.terms + a];
      Pack sum = all(0);
      for (int e = 0; e < ends.count && factor != 0; ++e) {
        Pack value = all(factor * ends.share);
        for (int c = 0; c < Dim; ++c) {
          const int exponent = task.exponents[a * Dim + c] - task.orders[d * Dim + c];
          for (int k = 0; k < exponent; ++k) value = value * ends.offsets[e][c];
        }
        sum = sum + value;
      }
      group.weights(a, first + d) = sum;
    }
  }
}

/// The derivatives of r^phs, x from a node, which are taken as zero at r = 0, times a factor.
template <int Dim>
void add_radial(const PolyharmonicTask& task, const Pack* x, int order, double factor, Pack* sums,
                long step) {
  constexpr int highest = 12;  // above phs, and derivatives are of lower orders
  Pack square = all(0);
  for (int c = 0; c < Dim; ++c) square = square + x[c] * x[c];
  const Pack inverse = all(1) / choose_less(all(0), square, square, all(1));
  Pack f[highest];
  f[0] = odd_power(square, task.phs / 2) * all(factor);
  for (int k = 0; k < order; ++k) f[k + 1] = f[k] * inverse * all(0.5 * task.phs - k);
  for (int d = 0; d < task.derivatives; ++d) {
    Pack sum = sums[d * step];
    for (int t = task.radial_offsets[d]; t < task.radial_offsets[d + 1]; ++t) {
      const RadialTerm& term = task.radial[t];
      const Pack power = monomial<Dim>(x, term.exponents);
      sum = sum + all(term.coefficient) * power * f[term.outer];
    }
    sums[d * step] = sum;
  }
}

/// The right-hand sides of r^phs.
template <int Dim>
void fill_radial(const PolyharmonicTask& task, const PolyharmonicGroup& group,
                 const Ends<Dim>& ends, int first) {
  int order = 0;
  for (int t = 0; t < task.radial_offsets[task.derivatives]; ++t) {
    if (task.radial[t].outer > order) order = task.radial[t].outer;
  }
  for (int i = 0; i < task.table.size; ++i) {
    for (int d = 0; d < task.derivatives; ++d) group.radial(i, first + d) = all(0);
    for (int e = 0; e < ends.count; ++e) {
      Pack x[Dim];
      for (int c = 0; c < Dim; ++c) x[c] = ends.offsets[e][c] - group.stencils.z[i * Dim + c];
      add_radial<Dim>(task, x, order, ends.share, &group.radial(i, first), group.radial.column);
    }
  }
}

/// Weights of all right-hand sides, w = [w1 - T^T w2; w2] with P1^T w1 = constraints and
/// projected w2 = radial2 - T radial1 - C w1.
void solve(const PolyharmonicTask& task, const PolyharmonicGroup& group, int columns) {
  const int m = task.terms;
  const int rest = task.table.size - m;
  const LaneMatrix transposed = group.polynomials.transposed();
  const LaneMatrix projection = group.polynomials.block(m, 0);
  const LaneMatrix others = group.radial.block(m, 0);
  solve_lower(m, transposed, group.inverse, columns, group.weights);
  solve_upper(m, transposed, nullptr, columns, group.weights);
  subtract_product(rest, columns, others, projection, group.radial, m);
  subtract_product(rest, columns, others, group.coupling, group.weights, m);
  solve_lower(rest, group.projected, nullptr, columns, others);
  solve_upper(rest, group.projected, group.inverse_pivots, columns, others);
  subtract_product(m, columns, group.weights, projection.transposed(), others, rest);
}

/// Multiplies the weights by R^-order and puts them all into `radial`. Gives the bits of lanes
/// where they are finite.
template <int Dim>
unsigned scale(const PolyharmonicTask& task, const PolyharmonicGroup& group, int columns) {
  const Pack infinite = all(__builtin_inf());
  const Pack inverse = all(1) / group.stencils.radius;
  unsigned finite = every_lane;
  for (int q = 0; q < columns; ++q) {
    const int* const order = task.orders + q % task.derivatives * Dim;
    Pack unit = all(1);
    for (int c = 0; c < Dim; ++c) {
      for (int k = 0; k < order[c]; ++k) unit = unit * inverse;
    }
    for (int i = 0; i < task.table.size; ++i) {
      const Pack weight = unit * (i < task.terms ? group.weights(i, q) : group.radial(i, q));
      finite &= less(abs(weight), infinite);
      group.radial(i, q) = weight;
    }
  }
  return finite;
}

/// Writes the weights of one lane at one of its points.
void write(const PolyharmonicTask& task, const PolyharmonicGroup& group, int lane, int point,
           int first) {
  const long step = group.radial.column * lanes;
  const double* const places = reinterpret_cast<const double*>(group.place) + lane;
  const double* from = reinterpret_cast<const double*>(&group.radial(0, first)) + lane;
  double* const row = task.values + task.value_offsets[point] * task.derivatives;
  for (int i = 0; i < task.table.size; ++i, from += lanes) {
    double* const entry = row + static_cast<long>(places[i * lanes]) * task.derivatives;
    for (int d = 0; d < task.derivatives; ++d) entry[d] = from[d * step];
  }
}

/// Asks for the memory that the weights of a point will be written to.
void fetch_row(const PolyharmonicTask& task, int point) {
  constexpr long line = 8;  // numbers in a cache line
  const long count = static_cast<long>(task.table.size) * task.derivatives;
  const double* const row = task.values + task.value_offsets[point] * task.derivatives;
  for (long i = 0; i < count; i += line) __builtin_prefetch(row + i, 1);
  __builtin_prefetch(row + count - 1, 1);
}

/// Evaluation points of a group's anchors.
struct GroupPoints {
  const int* ids[lanes];
  int counts[lanes];
  int most = 0;

  GroupPoints(const PolyharmonicTask& task, const PolyharmonicGroup& group) {
    for (int lane = 0; lane < lanes; ++lane) {
      const std::int64_t* const begin = task.point_offsets + group.stencils.anchors[lane];
      ids[lane] = task.point_ids + begin[0];
      counts[lane] = static_cast<int>(begin[1] - begin[0]);
      if (counts[lane] > most) most = counts[lane];
    }
  }
};

/// Where point q of each anchor lies; lanes with fewer points repeat their last one.
template <int Dim>
Ends<Dim> ends_of(const PolyharmonicTask& task, const PolyharmonicGroup& group,
                  const GroupPoints& points, int q) {
  Ends<Dim> ends;
  ends.count = task.spans == nullptr ? 1 : 2;
  ends.share = task.spans == nullptr ? 1 : 0.5;
  const Pack inverse = all(1) / group.stencils.radius;
  for (int c = 0; c < Dim; ++c) {
    double along[lanes];
    double half[lanes];
    for (int lane = 0; lane < lanes; ++lane) {
      const int last = points.counts[lane] - 1;
      const long point = last < 0 ? -1 : points.ids[lane][q < last ? q : last];
      const double anchor =
          task.table.anchors[static_cast<long>(group.stencils.anchors[lane]) * Dim + c];
      along[lane] = point < 0 ? 0 : task.points[point * Dim + c] - anchor;
      half[lane] = point < 0 || task.spans == nullptr ? 0 : task.spans[point * Dim + c];
    }
    const Pack middle = load(along) * inverse;
    const Pack span = load(half) * inverse;
    ends.offsets[0][c] = task.spans == nullptr ? middle : middle - span;
    ends.offsets[1][c] = middle + span;
  }
  return ends;
}

/// Evaluates all points of a group's anchors, some at a time. Gives the bits of lanes where all is
/// finite, of those in `good`, which are written.
template <int Dim>
unsigned evaluate(const PolyharmonicTask& task, const PolyharmonicGroup& group, unsigned good) {
  const int at_a_time = polyharmonic_columns(task.derivatives) / task.derivatives;
  const GroupPoints all_points(task, group);
  const int most = all_points.most;
  for (int begin = 0; begin < most; begin += at_a_time) {
    const int points = most - begin < at_a_time ? most - begin : at_a_time;
    for (int lane = 0; lane < lanes; ++lane) {
      for (int q = begin; q < begin + points && q < all_points.counts[lane]; ++q)
        fetch_row(task, all_points.ids[lane][q]);
    }
    for (int q = 0; q < points; ++q) {
      const Ends<Dim> ends = ends_of<Dim>(task, group, all_points, begin + q);
      fill_constraints<Dim>(task, group, ends, q * task.derivatives);
      fill_radial<Dim>(task, group, ends, q * task.derivatives);
    }
    solve(task, group, points * task.derivatives);
    good &= scale<Dim>(task, group, points * task.derivatives);
    for (int lane = 0; lane < lanes; ++lane) {
      if ((good >> lane & 1U) == 0) continue;
      for (int q = 0; q < points && begin + q < all_points.counts[lane]; ++q) {
        write(task, group, lane, all_points.ids[lane][begin + q], q * task.derivatives);
      }
    }
  }
  return good;
}

template <int Dim>
void weigh(const PolyharmonicTask& task) {
  PolyharmonicGroup group = make_group(task);
  for (int first = 0; first < task.table.count; first += lanes) {
    const int left = task.table.count - first;
    gather_squares<Dim>(task.table, first, group.stencils);
    unsigned good = ~group.stencils.coincident & every_lane;
    if (left < lanes) good &= (1U << left) - 1;
    if (good != 0) good &= factorise_polynomials<Dim>(task, group);
    if (good != 0) good &= factorise_projected<Dim>(task, group);
    if (good != 0) good &= evaluate<Dim>(task, group, good);
    for (int lane = 0; lane < lanes && lane < left; ++lane) {
      task.served[first + lane] = good >> lane & 1U;
    }
  }
}

}  // namespace

void polyharmonic_weights(const PolyharmonicTask& task) {
  switch (task.dimension) {
    case 1:
      return weigh<1>(task);
    case 2:
      return weigh<2>(task);
    default:
      return weigh<3>(task);
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
