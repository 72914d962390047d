#include "problems/core/random.hpp"

#include <cmath>

#include "problems/core/layouts/seed.hpp"
#include "problems/core/node_fill.hpp"

namespace strongpoint {
namespace {

/// Nodes closer than this fraction of the spacing are as good as coincident.
constexpr double least_distance = 0.05;

/// Nodes inside that make the cloud as dense as a grid of spacing h, where a node inside owns a
/// cell and a node on k sides 2^-k of one. On the unit cube the cloud has exactly level^Dim nodes.
template <int Dim>
int interior_count(const Domain<Dim>& domain, const NodeSet<Dim>& set, double h) {
  double cells = domain.measure() / std::pow(h, Dim);
  for (const std::vector<int>& sides : set.sides) {
    cells -= std::pow(0.5, static_cast<double>(sides.size()));
  }
  return std::max(0, static_cast<int>(std::lround(cells)));
}

/// Adds `count` nodes, independent and uniform inside the domain but for the least distance. Random
/// numbers are drawn coordinate by coordinate, rejected positions included.
template <int Dim>
void add_uniform(const Domain<Dim>& domain, int count, double h, std::mt19937_64& generator,
                 NodeSet<Dim>& set) {
  Point<Dim> low = set.nodes[0], high = set.nodes[0];
  for (int i = 1; i < set.nodes.size(); ++i) {
    low = low.cwiseMin(set.nodes[i]);
    high = high.cwiseMax(set.nodes[i]);
  }
  constexpr int most_tries =
      10000;  // per node: a domain that fills 0.1 % of its box still succeeds
  for (int added = 0, tries = 0; added < count; ++tries) {
    if (tries > most_tries) {
      throw CaseError(
          fmt::format("random: no free place for node {} of {} after {} tries; lower the "
                      "level or use scattered",
                      added + 1, count, most_tries));
    }
    Point<Dim> x;
    for (int c = 0; c < Dim; ++c) x[c] = low[c] + uniform01(generator) * (high[c] - low[c]);
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
       "independent uniform nodes inside, equidistant ones on the boundary",
       {seed_option()}},
      []<int Dim>(const Domain<Dim>& domain, const Options& options, const LayoutRequest& request) {
        std::mt19937_64 generator(seed_of(options, request));
        const double h = domain.reference_length() / (request.level - 1);
        NodeSet<Dim> set = fill_boundary<Dim>(
            domain, [h](const Point<Dim>&) { return h; }, generator);
        add_uniform(domain, interior_count(domain, set, h), h, generator, set);
        return to_cloud(domain, set);
      });
}

}  // namespace strongpoint
