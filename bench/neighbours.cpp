#include "methods/core/neighbours.hpp"

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "bench/neighbour_goals.hpp"
#include "bench/report.hpp"
#include "problems/core/random.hpp"

namespace strongpoint {
namespace {

/// Seed of the nodes, which are uniform random in the unit cube, in random order.
constexpr std::uint64_t seed = 1;

/// Queries given to brute force, whose cost per query is that of the whole cloud; the same number
/// are checked against it before an engine is timed.
constexpr int few_queries = 200;

/// One table row: engine, dimension (by template), stencil size, nodes.
struct Setup {
  std::string engine;
  int k;
  int nodes;
};

/// The cloud of a size, kept for the benchmarks that follow.
template <int Dim>
const Points<Dim>& random_nodes(int count) {
  static Points<Dim> nodes;
  if (nodes.cols() != count) {
    std::mt19937_64 generator(seed);
    nodes.resize(Dim, count);
    for (int i = 0; i < count; ++i) {
      for (int c = 0; c < Dim; ++c) nodes(c, i) = uniform01(generator);
    }
  }
  return nodes;
}

/// Nodes spread over the cloud.
template <int Dim>
Points<Dim> sample(const Points<Dim>& nodes) {
  std::vector<int> ids;
  ids.reserve(few_queries);
  for (int i = 0; i < few_queries; ++i) {
    ids.push_back(static_cast<int>(nodes.cols() * static_cast<Eigen::Index>(i) / few_queries));
  }
  return columns_of<Dim>(nodes, ids);
}

template <int Dim>
bool agrees_with_brute_force(const NeighbourSearch<Dim>& search, const Points<Dim>& nodes, int k) {
  const Points<Dim> queries = sample<Dim>(nodes);
  const Stencils expected = make_search<Dim>("brute", nodes)->nearest(queries, k, Ties::keep);
  const Stencils found = search.nearest(queries, k, Ties::keep);
  return found.offsets == expected.offsets && found.nodes == expected.nodes;
}

/// The k nearest nodes of every node (of a sample for brute force); the engine is built beforehand.
template <int Dim>
void search_nearest(benchmark::State& state, const Setup& setup) {
  const Points<Dim>& nodes = random_nodes<Dim>(setup.nodes);
  const auto search = make_search<Dim>(setup.engine, nodes);
  if (!agrees_with_brute_force<Dim>(*search, nodes, setup.k)) {
    state.SkipWithError("the answer differs from brute force");
    return;
  }
  const Points<Dim> queries = setup.engine == "brute" ? sample<Dim>(nodes) : nodes;
  for (auto _ : state) {
    benchmark::DoNotOptimize(search->nearest(queries, setup.k, Ties::keep));
  }
  state.SetItemsProcessed(state.iterations() * queries.cols());
}

/// Building an engine, per node.
template <int Dim>
void build_engine(benchmark::State& state, const Setup& setup) {
  const Points<Dim>& nodes = random_nodes<Dim>(setup.nodes);
  for (auto _ : state) benchmark::DoNotOptimize(make_search<Dim>(setup.engine, nodes));
  state.SetItemsProcessed(state.iterations() * nodes.cols());
}

/// Process CPU time is reported: it does not depend on the number of threads.
template <int Dim>
void register_size(int nodes, const std::vector<int>& stencil_sizes) {
  for (const char* engine : {"nanoflann", "grid", "bucket", "brute"}) {
    for (int k : stencil_sizes) {
      const std::string name =
          fmt::format("nearest/{}/dim:{}/k:{}/nodes:{}/seed:{}", engine, Dim, k, nodes, seed);
      benchmark::RegisterBenchmark(name.c_str(), search_nearest<Dim>, Setup{engine, k, nodes})
          ->MeasureProcessCPUTime()
          ->Unit(benchmark::kMillisecond);
    }
    if (std::string(engine) == "brute") continue;
    const std::string name =
        fmt::format("build/{}/dim:{}/nodes:{}/seed:{}", engine, Dim, nodes, seed);
    benchmark::RegisterBenchmark(name.c_str(), build_engine<Dim>, Setup{engine, 0, nodes})
        ->MeasureProcessCPUTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace strongpoint

int main(int argc, char** argv) {
  bool failed = false;
  strongpoint::register_neighbour_goals(failed);
  for (int nodes : {10000, 100000, 1000000}) {
    strongpoint::register_size<2>(nodes, {9, 15, 25});
    strongpoint::register_size<3>(nodes, {30});
  }
  return strongpoint::run_registered(argc, argv, failed);
}
