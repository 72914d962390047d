#include "problems/core/voronoi.hpp"

#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <omp.h>

#include "bench/goal.hpp"
#include "bench/voronoi_rivals.hpp"
#include "problems/core/random.hpp"

namespace strongpoint {
namespace {

/// Nodes, some, and runs of each: voro++ needs 10 us a node, 27 us where they are graded.
template <int Dim>
constexpr int nodes_in_all = Dim == 2 ? 100000 : 40000;
template <int Dim>
constexpr int repeats = Dim == 2 ? 7 : 5;
constexpr std::uint64_t seed = 1;

/// The rivals compute vertices in their own ways: those of flat triangles carry round-off.
constexpr double same_answer = 1e-6;  // of a cell's measure

/// voro++ leaves a cut undone that is shallower than this: its tolerance of 1e-11 is one of normal
/// times height, in units of its container, and bisectors come with normals as long as the cell is
/// wide.
constexpr double shallow_cut = 1e-11;

/// How the nodes lie in the unit cube: anywhere, on a moved grid, or ever closer to a corner.
enum class Cloud { random, grid, graded };

/// Position of a node; `unit` is uniform in the unit cube.
template <int Dim>
Point<Dim> graded(const Point<Dim>& unit) {
  // Maps the cube onto itself; spacings span some 1e-4 to 3 of the mean one.
  const double reach = unit.maxCoeff();
  return reach * reach * unit;
}

/// Nodes in the order of a Hilbert curve, none of them on the boundary.
template <int Dim>
PointCloud<Dim> make_cloud(Cloud kind) {
  std::mt19937_64 generator(seed);
  const int n = static_cast<int>(std::lround(std::pow(nodes_in_all<Dim>, 1.0 / Dim)));
  const int count =
      kind == Cloud::grid ? static_cast<int>(std::lround(std::pow(n, Dim))) : nodes_in_all<Dim>;
  Points<Dim> nodes(Dim, count);
  for (int i = 0; i < count; ++i) {
    Point<Dim> x;
    for (int c = 0, rest = i; c < Dim; ++c, rest /= n) {
      const double u = uniform01(generator);
      x[c] = kind == Cloud::grid ? (rest % n + 0.5 + 0.6 * (u - 0.5)) / n : u;
    }
    nodes.col(i) = kind == Cloud::graded ? graded<Dim>(x) : x;
  }
  PointCloud<Dim> cloud;
  cloud.nodes = in_spatial_order<Dim>(nodes);
  cloud.mark_offsets.assign(static_cast<std::size_t>(count) + 1, 0);
  cloud.measure = 1;
  return cloud;
}

/// Gives again what another search found, call by call: leaves the cells' own time.
template <int Dim>
class Replay final : public NeighbourSearch<Dim> {
 public:
  explicit Replay(const NeighbourSearch<Dim>& search) : search_(search) {}
  /// Starts over with the first call.
  void rewind() { next_ = 0; }
  Stencils nearest(const Points<Dim>& queries, int k, Ties ties) const override {
    if (next_ == found_.size()) found_.push_back(search_.nearest(queries, k, ties));
    return found_[next_++];
  }
  Stencils within(const Points<Dim>& queries, std::span<const double> radii) const override {
    if (next_ == found_.size()) found_.push_back(search_.within(queries, radii));
    return found_[next_++];
  }

 private:
  const NeighbourSearch<Dim>& search_;
  mutable std::vector<Stencils> found_;
  mutable std::size_t next_ = 0;
};

/// Throws CaseError unless the measures agree wherever the rival gives one that it can resolve.
template <int Dim>
void check_answers(const Eigen::VectorXd& ours, const std::vector<double>& theirs) {
  int compared = 0;
  for (int i = 0; i < ours.size(); ++i) {
    if (std::isnan(theirs[i])) continue;
    double tolerance = same_answer;
    if constexpr (Dim == 3) tolerance += shallow_cut * std::pow(theirs[i], -2.0 / 3);
    if (tolerance < 1e-4) ++compared;
    if (!(std::abs(ours[i] - theirs[i]) <= tolerance * theirs[i])) {
      throw CaseError(fmt::format("cell of node {}: {} here, {} there", i, ours[i], theirs[i]));
    }
  }
  if (compared < 0.9 * static_cast<double>(ours.size())) throw CaseError("too few cells compared");
  if (std::abs(ours.sum() - 1) > 1e-10) throw CaseError("the cells do not fill the cube");
}

/// Whether finding neighbours counts.
enum class Search { counted, replayed };

template <int Dim>
Contest prepare(Cloud kind, Search search) {
  const auto cloud = std::make_shared<const PointCloud<Dim>>(make_cloud<Dim>(kind));
  const auto cube = std::make_shared<const UnitCube<Dim>>();
  const std::shared_ptr<const NeighbourSearch<Dim>> engine = make_search<Dim>("auto", cloud->nodes);
  check_answers<Dim>(voronoi_volumes<Dim>(*cloud, *cube, *engine), rival_measures(cloud->nodes));
  Contest contest;
  contest.nodes = cloud->size();
  contest.repeats = repeats<Dim>;
  contest.label = fmt::format("N {}, seed {}, sorted, {}", cloud->size(), seed,
                              search == Search::counted ? "search included" : "without search");
  contest.rival = [cloud] { benchmark::DoNotOptimize(rival_measures(cloud->nodes)); };
  if (search == Search::counted) {
    contest.subject = [cloud, cube] {
      benchmark::DoNotOptimize(
          voronoi_volumes<Dim>(*cloud, *cube, *make_search<Dim>("auto", cloud->nodes)));
    };
  } else {
    const auto replay = std::make_shared<Replay<Dim>>(*engine);
    contest.subject = [cloud, cube, engine, replay] {
      replay->rewind();
      benchmark::DoNotOptimize(voronoi_volumes<Dim>(*cloud, *cube, *replay));
    };
    contest.subject();
  }
  return contest;
}

template <int Dim>
void add_goals(bool& failed) {
  struct Named {
    const char* name;
    Cloud kind;
  };
  for (const Named& cloud :
       {Named{"random", Cloud::random}, {"grid", Cloud::grid}, {"graded", Cloud::graded}}) {
    const Goal goal{fmt::format("voronoi/{}d/{}", Dim, cloud.name),
                    Dim == 2 ? "CGAL Delaunay" : "voro++", Dim == 2 ? 2.0 : 3.0,
                    Dim == 2 ? 3.5 : 6.0};
    add_goal(goal, failed, [=] { return prepare<Dim>(cloud.kind, Search::counted); });
    Goal alone = goal;
    alone.name += "/cells_alone";
    add_goal(alone, failed, [=] { return prepare<Dim>(cloud.kind, Search::replayed); });
  }
}

}  // namespace
}  // namespace strongpoint

int main(int argc, char** argv) {
  omp_set_num_threads(1);  // the rivals use one
  bool failed = false;
  strongpoint::add_goals<2>(failed);
  strongpoint::add_goals<3>(failed);
  return strongpoint::run_registered(argc, argv, failed);
}
