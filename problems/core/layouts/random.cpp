#include "problems/core/random.hpp"

#include <cmath>
#include <cstdint>

#include "problems/core/layouts/seed.hpp"
#include "problems/core/layouts/toward.hpp"
#include "problems/core/node_fill.hpp"

namespace strongpoint {
namespace {

/// Nodes closer than this fraction of the spacing are as good as coincident.
constexpr double least_distance = 0.05;

/// The wanted density of nodes.
template <int Dim>
struct Density {
  double h;                   ///< spacing where no factor applies
  SpacingFactor<Dim> factor;  ///< of the spacing, at most 1; empty: 1 everywhere

  double spacing(const Point<Dim>& x) const { return factor ? h * factor(x) : h; }
};

/// Integral of 1 / spacing^Dim over the part of a domain in a box, by the midpoint rule on cells
/// that are halved until they are no longer than the spacing.
template <int Dim>
double cells_in(const Domain<Dim>& domain, const Density<Dim>& density, const Point<Dim>& centre,
                const Point<Dim>& half) {
  const double depth = -domain.distance(centre);
  if (depth < -half.norm()) return 0;
  const double h = density.spacing(centre);
  if (2 * half.maxCoeff() <= h) return depth > 0 ? (2 * half / h).prod() : 0;
  double sum = 0;
  for (int child = 0; child < 1 << Dim; ++child) {
    Point<Dim> shift = half / 2;
    for (int c = 0; c < Dim; ++c) {
      if (((child >> c) & 1) != 0) shift[c] = -shift[c];
    }
    sum += cells_in<Dim>(domain, density, centre + shift, half / 2);
  }
  return sum;
}

/// A box around nodes.
template <int Dim>
struct Box {
  Point<Dim> low, high;
};

template <int Dim>
Box<Dim> box_around(const NodeSet<Dim>& set) {
  Box<Dim> box{set.nodes[0], set.nodes[0]};
  for (int i = 1; i < set.nodes.size(); ++i) {
    box.low = box.low.cwiseMin(set.nodes[i]);
    box.high = box.high.cwiseMax(set.nodes[i]);
  }
  return box;
}

/// Nodes inside that make the cloud as dense as a grid of the wanted spacing, where a node inside
/// owns a cell and a node on k sides 2^-k of one. On the unit cube the cloud has exactly level^Dim
/// nodes.
template <int Dim>
int interior_count(const Domain<Dim>& domain, const NodeSet<Dim>& set,
                   const Density<Dim>& density) {
  double cells = domain.measure() / std::pow(density.h, Dim);
  if (density.factor) {
    const auto [low, high] = box_around(set);
    cells = cells_in<Dim>(domain, density, (low + high) / 2, (high - low) / 2);
  }
  for (const std::vector<int>& sides : set.sides) {
    cells -= std::pow(0.5, static_cast<double>(sides.size()));
  }
  return std::max(0, static_cast<int>(std::lround(cells)));
}

/// Adds `count` nodes, independent inside the domain but for the least distance, as dense as
/// wanted. Random numbers are drawn coordinate by coordinate, rejected positions included, and one
/// more where the density varies.
template <int Dim>
void add_independent(const Domain<Dim>& domain, int count, const Density<Dim>& density,
                     std::mt19937_64& generator, NodeSet<Dim>& set) {
  const auto [low, high] = box_around(set);
  // A position is kept with the probability (finest / spacing)^Dim.
  double finest = density.h;
  for (int i = 0; i < set.nodes.size(); ++i) {
    finest = std::min(finest, density.spacing(set.nodes[i]));
  }
  const double rarest = std::pow(finest / density.h, Dim);
  // Per node: a domain that fills 0.1 % of its box still succeeds.
  const auto most_tries = static_cast<std::int64_t>(10000 / rarest);
  std::int64_t tries = 0;
  for (int added = 0; added < count; ++tries) {
    if (tries > most_tries) {
      throw CaseError(
          fmt::format("random: no free place for node {} of {} after {} tries; lower the "
                      "level or use scattered",
                      added + 1, count, most_tries));
    }
    Point<Dim> x;
    for (int c = 0; c < Dim; ++c) x[c] = low[c] + uniform01(generator) * (high[c] - low[c]);
    const double h = density.spacing(x);
    if (density.factor && uniform01(generator) >= std::pow(finest / h, Dim)) continue;
    if (!(domain.distance(x) < 0) || set.nodes.find_within(x, least_distance * h) >= 0) continue;
    set.nodes.add(x);
    set.sides.emplace_back();
    ++added;
    tries = 0;
  }
}

}  // namespace

/// Registers `random`: equidistant on the boundary, independent and uniform inside.
LayoutEntry layout_random() {
  return layout_entry(
      {"random",
       "independent nodes inside, uniform unless graded, equidistant ones on the boundary",
       with_grading_options({seed_option()})},
      []<int Dim>(const Domain<Dim>& domain, const Options& options, const LayoutRequest& request) {
        std::mt19937_64 generator(seed_of(options, request));
        const Density<Dim> density{domain.reference_length() / (request.level - 1),
                                   grading_of<Dim>(options, domain)};
        NodeSet<Dim> set = fill_boundary<Dim>(
            domain, [&](const Point<Dim>& x) { return density.spacing(x); }, generator);
        add_independent(domain, interior_count(domain, set, density), density, generator, set);
        return to_cloud(domain, set);
      });
}

}  // namespace strongpoint
