#include "methods/core/simd/polyharmonic_kernel.hpp"

#include "methods/core/simd/lane_algebra.hpp"
#include "methods/core/simd/lane_gather.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// Smallest pivot of the polynomials over the largest entry of its column, and smallest pivot of
/// the projected matrix over its diagonal entry, that are served here: far from where the one by
/// one path refuses (1e-11 and 1e-14).
constexpr double polynomial_tolerance = 1e-8;
constexpr double definite_tolerance = 1e-11;

/// Buffers of a group of stencils. Nodes are in the order in which the polynomials choose them.
struct Group {
  LaneStencils stencils;
  Pack* place;             ///< (n) where a node stands in its stencil
  LaneMatrix polynomials;  ///< (n, m) L1 and U; below them first L2, then T
  Pack* inverse;           ///< (m) of the diagonal of U
  LaneMatrix chosen;       ///< (m, m) r^phs between the chosen nodes
  LaneMatrix mixed;        ///< (n - m, m) between the others and the chosen ones
  LaneMatrix coupling;     ///< (n - m, m) C = mixed - T chosen
  LaneMatrix projected;    ///< (n - m, n - m) r^phs in the null space, then its factors
  Pack* inverse_pivots;    ///< (n - m)
  LaneMatrix radial;       ///< (n, columns) right-hand sides, then weights of the nodes m to n
  LaneMatrix weights;      ///< (m, columns) right-hand sides, then weights of the nodes 0 to m
};

Group make_group(const PolyharmonicTask& task) {
  const long n = task.table.size;
  const long m = task.terms;
  const long rest = n - m;
  const long columns = polyharmonic_columns(task.derivatives);
  Pack* next = reinterpret_cast<Pack*>(task.room);
  const auto take = [&next](long count) {
    Pack* const taken = next;
    next += count;
    return taken;
  };
  Group group;
  group.stencils.z = take(n * task.dimension);
  group.stencils.rho = take(n);
  group.place = take(n);
  group.polynomials = {take(n * m), m, 1};
  group.inverse = take(m);
  group.chosen = {take(m * m), m, 1};
  group.mixed = {take(rest * m), m, 1};
  group.coupling = {take(rest * m), m, 1};
  group.projected = {take(rest * rest), rest, 1};
  group.inverse_pivots = take(rest);
  group.radial = {take(n * columns), 1, n};
  group.weights = {take(m * columns), 1, m};
  return group;
}

/// z^exponents.
template <int Dim>
Pack monomial(const Pack* z, const int* exponents) {
  Pack value = all(1);
  for (int c = 0; c < Dim; ++c) {
    for (int k = 0; k < exponents[c]; ++k) value = value * z[c];
  }
  return value;
}

/// Exchanges `count` packs of two rows in some lanes.
void exchange(unsigned bits, Pack* a, Pack* b, int count) {
  for (int e = 0; e < count; ++e) {
    const Pack before = a[e];
    a[e] = choose(bits, b[e], before);
    b[e] = choose(bits, before, b[e]);
  }
}

/// Brings, in each lane, the node with the largest entry of column k to row k, where rows have
/// `filled` entries. Gives that entry's size.
template <int Dim>
Pack exchange_nodes(const Group& group, int n, int k, int filled) {
  Pack largest = all(0);
  for (int i = k; i < n; ++i) largest = max(largest, abs(group.polynomials(i, k)));
  Pack row = all(k);
  Pack here = all(n);
  for (int i = n - 1; i >= k; --i) {
    here = here - all(1);
    row = choose(less(abs(group.polynomials(i, k)), largest), row, here);
  }
  double rows[lanes];
  store(rows, row);
  unsigned left = less(all(k), row);
  for (int lane = 0; lane < lanes; ++lane) {
    if ((left >> lane & 1U) == 0) continue;
    const int i = static_cast<int>(rows[lane]);
    const unsigned bits = less(abs(row - all(i)), all(0.5));
    left &= ~bits;
    exchange(bits, group.stencils.z + k * Dim, group.stencils.z + i * Dim, Dim);
    exchange(bits, group.place + k, group.place + i, 1);
    exchange(bits, &group.polynomials(k, 0), &group.polynomials(i, 0), filled);
  }
  return largest;
}

/// Fills a column with a monomial at all nodes. Gives its largest entry's size.
template <int Dim>
Pack fill_monomial(const Group& group, int n, int k, const int* exponents) {
  const LaneMatrix column = group.polynomials.block(0, k);
  for (int i = 0; i < n; ++i) column(i, 0) = all(1);
  for (int c = 0; c < Dim; ++c) {
    for (int power = 0; power < exponents[c]; ++power) {
      for (int i = 0; i < n; ++i) column(i, 0) = column(i, 0) * group.stencils.z[i * Dim + c];
    }
  }
  Pack largest = all(0);
  for (int i = 0; i < n; ++i) largest = max(largest, abs(column(i, 0)));
  return largest;
}

/// LU of the polynomials, nodes being exchanged, a few columns at a time. Gives the bits of lanes
/// where the columns are safely independent.
template <int Dim>
unsigned factorise_polynomials(const PolyharmonicTask& task, const Group& group) {
  const int n = task.table.size;
  const LaneMatrix& lu = group.polynomials;
  unsigned good = every_lane;
  for (int i = 0; i < n; ++i) group.place[i] = all(i);
  for (int begin = 0; begin < task.terms; begin += panel) {
    const int end = begin + panel < task.terms ? begin + panel : task.terms;
    Pack column[panel];
    for (int k = begin; k < end; ++k) {
      column[k - begin] = fill_monomial<Dim>(group, n, k, task.exponents + k * Dim);
    }
    solve_lower(begin, lu, nullptr, end - begin, lu.block(0, begin));
    subtract_product(n - begin, end - begin, lu.block(begin, begin), lu.block(begin, 0),
                     lu.block(0, begin), begin);
    for (int k = begin; k < end; ++k) {
      const Pack pivot = exchange_nodes<Dim>(group, n, k, end);
      good &= less(all(polynomial_tolerance) * column[k - begin], pivot);
      const Pack inverse = all(1) / lu(k, k);
      group.inverse[k] = inverse;
      for (int i = k + 1; i < n; ++i) lu(i, k) = lu(i, k) * inverse;
      for (int j = k + 1; j < end; ++j) {
        const Pack factor = lu(k, j);
        for (int i = k + 1; i < n; ++i) lu(i, j) = lu(i, j) - lu(i, k) * factor;
      }
    }
  }
  return good;
}

/// s^(1/2 + half).
Pack odd_power(Pack s, int half) {
  Pack value = sqrt(s);
  for (int k = 0; k < half; ++k) value = value * s;
  return value;
}

/// r^phs between node i and the nodes `begin` to `end`.
template <int Dim>
void fill_distances(const PolyharmonicTask& task, const Group& group, int i, int begin, int end,
                    Pack* values) {
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
unsigned factorise_projected(const PolyharmonicTask& task, const Group& group) {
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

/// Right-hand sides of all derivatives at a point: of the polynomials, in columns `first` and
/// following.
template <int Dim>
void fill_constraints(const PolyharmonicTask& task, const Group& group, const Pack* offset,
                      int first) {
  for (int d = 0; d < task.derivatives; ++d) {
    for (int a = 0; a < task.terms; ++a) {
      const double factor = task.factors[d * task.terms + a];
      Pack& value = group.weights(a, first + d);
      value = all(factor);
      for (int c = 0; c < Dim && factor != 0; ++c) {
        const int exponent = task.exponents[a * Dim + c] - task.orders[d * Dim + c];
        for (int k = 0; k < exponent; ++k) value = value * offset[c];
      }
    }
  }
}

/// The same of r^phs, whose derivatives are taken as zero at r = 0.
template <int Dim>
void fill_radial(const PolyharmonicTask& task, const Group& group, const Pack* offset, int first) {
  constexpr int highest = 12;  // above phs, and derivatives are of lower orders
  int order = 0;
  for (int t = 0; t < task.radial_offsets[task.derivatives]; ++t) {
    if (task.radial[t].outer > order) order = task.radial[t].outer;
  }
  for (int i = 0; i < task.table.size; ++i) {
    Pack x[Dim];
    Pack square = all(0);
    for (int c = 0; c < Dim; ++c) {
      x[c] = offset[c] - group.stencils.z[i * Dim + c];
      square = square + x[c] * x[c];
    }
    const Pack inverse = all(1) / choose(less(all(0), square), square, all(1));
    Pack f[highest];
    f[0] = odd_power(square, task.phs / 2);
    for (int k = 0; k < order; ++k) f[k + 1] = f[k] * inverse * all(0.5 * task.phs - k);
    for (int d = 0; d < task.derivatives; ++d) {
      Pack sum = all(0);
      for (int t = task.radial_offsets[d]; t < task.radial_offsets[d + 1]; ++t) {
        const RadialTerm& term = task.radial[t];
        const Pack power = monomial<Dim>(x, term.exponents);
        sum = sum + all(term.coefficient) * power * f[term.outer];
      }
      group.radial(i, first + d) = sum;
    }
  }
}

/// Weights of all right-hand sides, w = [w1 - T^T w2; w2] with P1^T w1 = constraints and
/// projected w2 = radial2 - T radial1 - C w1.
void solve(const PolyharmonicTask& task, const Group& group, int columns) {
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
unsigned scale(const PolyharmonicTask& task, const Group& group, int columns) {
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
void write(const PolyharmonicTask& task, const Group& group, int lane, int point, int first) {
  const long step = group.radial.column * lanes;
  const double* const places = reinterpret_cast<const double*>(group.place) + lane;
  const double* from = reinterpret_cast<const double*>(&group.radial(0, first)) + lane;
  double* const row = task.values + task.value_offsets[point] * task.derivatives;
  for (int i = 0; i < task.table.size; ++i, from += lanes) {
    double* const entry = row + static_cast<long>(places[i * lanes]) * task.derivatives;
    for (int d = 0; d < task.derivatives; ++d) entry[d] = from[d * step];
  }
}

/// Evaluates all points of a group's anchors, some at a time; lanes with fewer points repeat their
/// last one. Gives the bits of lanes where all is finite, of those in `good`, which are written.
template <int Dim>
unsigned evaluate(const PolyharmonicTask& task, const Group& group, unsigned good) {
  const int at_a_time = polyharmonic_columns(task.derivatives) / task.derivatives;
  const int* ids[lanes];
  int counts[lanes];
  int most = 0;
  for (int lane = 0; lane < lanes; ++lane) {
    const std::int64_t* const begin = task.point_offsets + group.stencils.anchors[lane];
    ids[lane] = task.point_ids + begin[0];
    counts[lane] = static_cast<int>(begin[1] - begin[0]);
    if (counts[lane] > most) most = counts[lane];
  }
  const Pack inverse = all(1) / group.stencils.radius;
  for (int begin = 0; begin < most; begin += at_a_time) {
    const int points = most - begin < at_a_time ? most - begin : at_a_time;
    for (int q = 0; q < points; ++q) {
      Pack offset[Dim];
      for (int c = 0; c < Dim; ++c) {
        double along[lanes];
        for (int lane = 0; lane < lanes; ++lane) {
          const int last = counts[lane] - 1;
          const long point = last < 0 ? -1 : ids[lane][begin + q < last ? begin + q : last];
          const double anchor =
              task.table.anchors[static_cast<long>(group.stencils.anchors[lane]) * Dim + c];
          along[lane] = point < 0 ? 0 : task.points[point * Dim + c] - anchor;
        }
        offset[c] = load(along) * inverse;
      }
      fill_constraints<Dim>(task, group, offset, q * task.derivatives);
      fill_radial<Dim>(task, group, offset, q * task.derivatives);
    }
    solve(task, group, points * task.derivatives);
    good &= scale<Dim>(task, group, points * task.derivatives);
    for (int lane = 0; lane < lanes; ++lane) {
      if ((good >> lane & 1U) == 0) continue;
      for (int q = 0; q < points && begin + q < counts[lane]; ++q) {
        write(task, group, lane, ids[lane][begin + q], q * task.derivatives);
      }
    }
  }
  return good;
}

template <int Dim>
void weigh(const PolyharmonicTask& task) {
  Group group = make_group(task);
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
