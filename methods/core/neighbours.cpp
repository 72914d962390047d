#include "methods/core/neighbours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/neighbours_brute.hpp"
#include "methods/core/neighbours_bucket.hpp"
#include "methods/core/neighbours_grid.hpp"
#include "methods/core/neighbours_group_search.hpp"
#include "methods/core/neighbours_line.hpp"
#include "methods/core/neighbours_nanoflann.hpp"
#include "methods/core/parallel_errors.hpp"

namespace strongpoint {
namespace {

/// Queries searched by one thread at a time: enough to hide the scheduling, few enough to share.
constexpr int block_size = 256;

/// Coordinates beyond this have squares that overflow, which would make all distances equal.
constexpr double largest_coordinate = 1e150;

template <int Dim>
void check_coordinates(const Points<Dim>& points, std::string_view what) {
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    // Written so that NaN fails it too.
    if ((points.col(i).array().abs() <= largest_coordinate).all()) continue;
    throw CaseError(
        fmt::format("{} {} of a neighbour search lies at {}: coordinates must be finite and at "
                    "most {:g}; check "
                    "where the cloud comes from",
                    what, i, format_point(points.col(i)), largest_coordinate));
  }
}

/// Joins what the blocks of queries found, in order.
Stencils concatenate(const std::vector<Stencils>& blocks) {
  std::size_t queries = 0;
  std::size_t entries = 0;
  for (const Stencils& block : blocks) {
    queries += static_cast<std::size_t>(block.size());
    entries += block.nodes.size();
  }
  Stencils all;
  all.offsets.reserve(queries + 1);
  all.nodes.reserve(entries);
  for (const Stencils& block : blocks) {
    const std::int64_t base = static_cast<std::int64_t>(all.nodes.size());
    for (int i = 0; i < block.size(); ++i) all.offsets.push_back(base + block.offsets[i + 1]);
    all.nodes.insert(all.nodes.end(), block.nodes.begin(), block.nodes.end());
  }
  return all;
}

/// Runs an engine over many queries, block by block in parallel. `Collector` is copied per block;
/// `start(collector, i)` readies it for query i.
template <int Dim, class Engine, class Collector, class Start>
Stencils search_all(const Engine& engine, const Points<Dim>& queries, const Collector& prototype,
                    const Start& start) {
  const int count = static_cast<int>(queries.cols());
  std::vector<Stencils> blocks(static_cast<std::size_t>((count + block_size - 1) / block_size));
  ParallelErrors errors;
  const auto search_block = [&](int b) {
    Collector collector = prototype;
    const int first = b * block_size;
    const int end = std::min(count, first + block_size);
    blocks[b].offsets.reserve(static_cast<std::size_t>(end - first) + 1);
    blocks[b].nodes.reserve(static_cast<std::size_t>(end - first) * prototype.expected());
    for (int i = first; i < end; ++i) {
      start(collector, i);
      engine.visit(queries.col(i), collector);
      for (const Candidate& found : collector.finish()) blocks[b].nodes.push_back(found.node);
      blocks[b].offsets.push_back(static_cast<std::int64_t>(blocks[b].nodes.size()));
    }
  };
#pragma omp parallel for schedule(dynamic)
  for (int b = 0; b < static_cast<int>(blocks.size()); ++b) {
    errors.guard(b, [&] { search_block(b); });
  }
  errors.rethrow();
  return concatenate(blocks);
}

/// The one batch layer over every engine.
template <int Dim, NeighbourEngine<Dim> Engine>
class BatchSearch final : public NeighbourSearch<Dim> {
 public:
  explicit BatchSearch(const Points<Dim>& nodes)
      : nodes_(nodes), count_(static_cast<int>(nodes.cols())), engine_(nodes) {}

  Stencils nearest(const Points<Dim>& queries, int k, Ties ties) const override {
    if (k < 1) throw std::invalid_argument(fmt::format("nearest: k = {} must be at least 1", k));
    check_coordinates<Dim>(queries, "query");
    if (count_ == 0) return all_empty(queries);
    k = std::min(k, count_);
    if constexpr (GroupEngine<Engine, Dim>) {
      if (k <= group_k_max) return nearest_in_groups<Dim>(engine_, nodes_, queries, k, ties);
    }
    const NearestCollector collector(k, ties);
    return search_all<Dim>(engine_, queries, collector,
                           [](NearestCollector& c, int) { c.clear(); });
  }

  const Engine& engine() const { return engine_; }

  Stencils within(const Points<Dim>& queries, std::span<const double> radii) const override {
    if (radii.size() != static_cast<std::size_t>(queries.cols())) {
      throw std::invalid_argument(fmt::format(
          "within: {} radii for {} queries; give one radius each", radii.size(), queries.cols()));
    }
    check_coordinates<Dim>(queries, "query");
    for (std::size_t i = 0; i < radii.size(); ++i) {
      if (!std::isnan(radii[i])) continue;
      throw CaseError(fmt::format("the search radius of query {} at {} is not a number", i,
                                  format_point(queries.col(static_cast<Eigen::Index>(i)))));
    }
    if (count_ == 0) return all_empty(queries);
    if constexpr (GroupEngine<Engine, Dim>) {
      return within_in_groups<Dim>(engine_, nodes_, queries, radii);
    }
    return search_all<Dim>(engine_, queries, RadiusCollector(),
                           [radii](RadiusCollector& c, int i) { c.clear(radii[i]); });
  }

 private:
  const Points<Dim>& nodes_;
  int count_;
  Engine engine_;

  static Stencils all_empty(const Points<Dim>& queries) {
    Stencils empty;
    empty.offsets.assign(static_cast<std::size_t>(queries.cols()) + 1, 0);
    return empty;
  }
};

/// An engine that can be asked for by name.
template <int Dim>
struct EngineEntry {
  std::string_view name;
  std::unique_ptr<NeighbourSearch<Dim>> (*make)(const Points<Dim>& nodes);
};

template <int Dim, template <int> class Engine>
std::unique_ptr<NeighbourSearch<Dim>> make_engine(const Points<Dim>& nodes) {
  return std::make_unique<BatchSearch<Dim, Engine<Dim>>>(nodes);
}

/// On a line an engine by order replaces the one by buckets.
template <int Dim>
struct BucketOrLine {
  using Engine = BucketEngine<Dim>;
};
template <>
struct BucketOrLine<1> {
  using Engine = LineEngine<1>;
};
template <int Dim>
using BucketEngineFor = typename BucketOrLine<Dim>::Engine;

/// The grid where the nodes are spread evenly, else buckets.
template <int Dim>
std::unique_ptr<NeighbourSearch<Dim>> make_fitting(const Points<Dim>& nodes) {
  if constexpr (Dim == 1) {
    return make_engine<1, LineEngine>(nodes);
  } else {
    auto grid = std::make_unique<BatchSearch<Dim, GridEngine<Dim>>>(nodes);
    if (grid->engine().is_even()) return grid;
    return make_engine<Dim, BucketEngine>(nodes);
  }
}

/// All engines.
template <int Dim>
constexpr std::array<EngineEntry<Dim>, 5> engines{{
    {"auto", &make_fitting<Dim>},
    {"brute", &make_engine<Dim, BruteEngine>},
    {"nanoflann", &make_engine<Dim, NanoflannEngine>},
    {"grid", &make_engine<Dim, GridEngine>},
    {"bucket", &make_engine<Dim, BucketEngineFor>},
}};

}  // namespace

const std::vector<std::string>& search_engines() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    list.reserve(engines<1>.size());
    for (const EngineEntry<1>& entry : engines<1>) list.emplace_back(entry.name);
    return list;
  }();
  return names;
}

template <int Dim>
std::unique_ptr<NeighbourSearch<Dim>> make_search(std::string_view engine,
                                                  const Points<Dim>& nodes) {
  for (const EngineEntry<Dim>& entry : engines<Dim>) {
    if (entry.name != engine) continue;
    check_coordinates<Dim>(nodes, "node");
    return entry.make(nodes);
  }
  throw UsageError(fmt::format("unknown neighbour search '{}'; known: {}", engine,
                               fmt::join(search_engines(), ", ")));
}

template std::unique_ptr<NeighbourSearch<1>> make_search<1>(std::string_view, const Points<1>&);
template std::unique_ptr<NeighbourSearch<2>> make_search<2>(std::string_view, const Points<2>&);
template std::unique_ptr<NeighbourSearch<3>> make_search<3>(std::string_view, const Points<3>&);

}  // namespace strongpoint
