#include "bench/neighbour_goals.hpp"

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nanoflann.hpp>
#include <omp.h>

#include "bench/goal.hpp"
#include "bench/neighbour_clouds.hpp"
#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

constexpr std::uint64_t seed = 1;
constexpr int node_count = 100000;

/// The rival: nanoflann's tree and result set for k neighbours, as its manual advises for a fixed
/// low dimension, with its default leaf size.
template <int Dim>
class Rival {
 public:
  explicit Rival(const Points<Dim>& nodes) : adaptor_{nodes}, tree_(Dim, adaptor_, {leaf_size}) {}

  /// The k nearest of every node, (k) after (k).
  void nearest(int k, std::vector<int>& ids) const {
    std::vector<double> squares(static_cast<std::size_t>(k));
    ids.resize(static_cast<std::size_t>(adaptor_.points.cols()) * k);
    for (Eigen::Index i = 0; i < adaptor_.points.cols(); ++i) {
      nanoflann::KNNResultSet<double, int, int> results(k);
      results.init(ids.data() + i * k, squares.data());
      tree_.findNeighbors(results, adaptor_.points.col(i).data(), nanoflann::SearchParams());
    }
  }

 private:
  static constexpr std::size_t leaf_size = 10;

  struct Adaptor {
    const Points<Dim>& points;

    std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(points.cols()); }
    double kdtree_get_pt(std::size_t node, std::size_t component) const {
      return points.data()[node * Dim + component];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };

  Adaptor adaptor_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Adaptor>, Adaptor, Dim,
                                      int>
      tree_;
};

/// Throws CaseError where the two answers differ; ties may come in any order.
template <int Dim>
void compare(const Points<Dim>& nodes, const Stencils& ours, const std::vector<int>& theirs, int k,
             bool is_exact) {
  for (int i = 0; i < nodes.cols(); ++i) {
    for (int j = 0; j < k; ++j) {
      const int a = ours[i][j];
      const int b = theirs[static_cast<std::size_t>(i) * k + j];
      const double da = (nodes.col(i) - nodes.col(a)).squaredNorm();
      const double db = (nodes.col(i) - nodes.col(b)).squaredNorm();
      if (is_exact ? a != b || static_cast<int>(ours[i].size()) != k : da != db) {
        throw CaseError(fmt::format("neighbour {} of node {} is {} or {}", j, i, a, b));
      }
    }
  }
}

/// Both build their structure and find the k nearest of every node.
template <int Dim>
void register_goal(const Goal& goal, Crowd crowd, int k, bool& failed) {
  add_goal(goal, failed, [=] {
    const auto nodes = std::make_shared<Points<Dim>>(sorted_crowd<Dim>(crowd, node_count, seed));
    const auto theirs = std::make_shared<std::vector<int>>();
    const auto run_ours = [=] {
      return make_search<Dim>("auto", *nodes)->nearest(*nodes, k, Ties::keep);
    };
    const auto run_theirs = [=] { Rival<Dim>(*nodes).nearest(k, *theirs); };
    run_theirs();
    compare<Dim>(*nodes, run_ours(), *theirs, k, crowd != Crowd::lattice);
    return Contest{.subject =
                       [=] {
                         // The rival has one thread, and waiting ones would count as well.
                         const int threads = omp_get_max_threads();
                         omp_set_num_threads(1);
                         benchmark::DoNotOptimize(run_ours());
                         omp_set_num_threads(threads);
                       },
                   .rival = run_theirs,
                   .nodes = static_cast<double>(nodes->cols()),
                   .label = fmt::format("{} nodes, {}, k = {}, seed {}, Hilbert order",
                                        nodes->cols(), name_of(crowd), k, seed)};
  });
}

template <int Dim>
void register_goals(int k, double uniform, double graded, double uniform_stretch,
                    double graded_stretch, bool& failed) {
  for (Crowd crowd : {Crowd::perturbed, Crowd::random, Crowd::lattice, Crowd::graded}) {
    const bool is_graded = crowd == Crowd::graded;
    // The design asks nothing of lattices, whose ties have to be put into exact order.
    const bool is_free = crowd == Crowd::lattice;
    register_goal<Dim>({.name = fmt::format("neighbours/{}d/{}", Dim, name_of(crowd)),
                        .rival = "nanoflann, tree and queries",
                        .ratio = is_free     ? 1
                                 : is_graded ? graded
                                             : uniform,
                        .stretch = is_free     ? 0
                                   : is_graded ? graded_stretch
                                               : uniform_stretch},
                       crowd, k, failed);
  }
}

}  // namespace

void register_neighbour_goals(bool& failed) {
  register_goals<2>(15, 6, 4.5, 9, 6, failed);
  register_goals<3>(30, 5, 4, 8, 6, failed);
}

}  // namespace strongpoint
