#include "problems/core/assembly.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/SparseCore>
#include <omp.h>

#include "bench/goal.hpp"
#include "methods/core/neighbours.hpp"
#include "methods/core/registry.hpp"
#include "problems/core/elasticity.hpp"
#include "problems/core/form.hpp"
#include "problems/core/layout.hpp"

namespace strongpoint {
namespace {

using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Which equations are assembled inside; every node of the boundary is held.
enum class Kind { poisson, elasticity };

/// Weights on a perturbed grid of the unit cube, and equations in Dim fields or one.
template <int Dim>
struct Scene {
  Kind kind;
  PointCloud<Dim> cloud;
  Derivatives<Dim> derivatives;
  Weights weights;
  EquationList equations;
  int fields = 1;
  std::string label;
};

template <int Dim>
void write_equations(Scene<Dim>& scene) {
  EquationWriter<Dim> write(scene.equations, scene.derivatives);
  scene.equations.reserve(scene.cloud.size() * scene.fields);
  for (int node = 0; node < scene.cloud.size(); ++node) {
    write.at(node);
    for (int i = 0; i < scene.fields; ++i) {
      if (scene.cloud.is_boundary(node)) {
        write.add(i, {}, 1);
      } else if (scene.kind == Kind::poisson) {
        for (int c = 0; c < Dim; ++c) write.add(0, partial<Dim>(c, c), 1);
      } else {
        add_equilibrium<Dim>(write, lame_constants(1, 0.3), i);
      }
      write.equals(1);
    }
  }
}

template <int Dim>
std::shared_ptr<Scene<Dim>> make_scene(Kind kind, int level, int k) {
  const std::string layout = "perturbed[amount=0.2,seed=1]";
  auto scene = std::make_shared<Scene<Dim>>();
  scene->kind = kind;
  scene->fields = kind == Kind::poisson ? 1 : Dim;
  scene->cloud = make_cloud<Dim>(UnitCube<Dim>(), layout, {.level = level});
  for (int i = 0; i < Dim; ++i) {
    for (int j = i; j < Dim; ++j) {
      if (i == j || kind == Kind::elasticity) scene->derivatives.merge({partial<Dim>(i, j)});
    }
  }
  const Sites<Dim> sites = sites_at_nodes<Dim>(Points<Dim>(scene->cloud.nodes));
  const auto search = make_search<Dim>("auto", sites.nodes);
  const auto method = make_method<Dim>("lsfdm").made;
  const Stencils stencils = search->nearest(sites.anchors, k, Ties::cut);
  scene->weights = method->weights(sites, stencils, scene->derivatives);
  write_equations(*scene);
  scene->label = fmt::format("lsfdm nearest[k={},ties=cut] Dim={} nodes={} {}", k, Dim,
                             scene->cloud.size(), layout);
  return scene;
}

/// The rival: a triplet an entry, its terms added up beforehand, in a list that has room for all.
/// Rows are not scaled.
template <int Dim>
Rows rows_from_triplets(const Scene<Dim>& scene) {
  const int fields = scene.fields;
  const Lame material = lame_constants(1, 0.3);
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(scene.weights.columns.size() * fields * fields);
  for (int node = 0; node < scene.cloud.size(); ++node) {
    const std::span<const int> stencil = scene.weights.nodes(node);
    const double* weights = scene.weights.row(node).data();
    for (int i = 0; i < fields; ++i) {
      const int row = node * fields + i;
      if (scene.cloud.is_boundary(node)) {
        triplets.emplace_back(row, row, 1);
        continue;
      }
      for (const int other : stencil) {
        double laplacian = 0;
        int slots[Dim][Dim];
        for (int a = 0, slot = 0; a < Dim; ++a) {
          for (int b = a; b < Dim; ++b) {
            if (a != b && scene.kind == Kind::poisson) continue;
            if (a == b) laplacian += weights[slot];
            slots[a][b] = slots[b][a] = slot++;
          }
        }
        for (int j = 0; j < fields; ++j) {
          double value = laplacian;
          if (scene.kind == Kind::elasticity) {
            value = (i == j ? material.mu * laplacian : 0) +
                    (material.lambda + material.mu) * weights[slots[i][j]];
          }
          triplets.emplace_back(row, other * fields + j, value);
        }
        weights += scene.weights.per_entry;
      }
      weights = scene.weights.row(node).data();
    }
  }
  const int unknowns = scene.cloud.size() * fields;
  Rows rows(unknowns, unknowns);
  rows.setFromTriplets(triplets.begin(), triplets.end());
  return rows;
}

template <int Dim>
LinearSystem assembled(const Scene<Dim>& scene) {
  return assemble(scene.equations, scene.weights, {.count = scene.cloud.size()}, scene.fields);
}

/// Throws CaseError unless both have the same entries, after the rows' scales.
void compare(const LinearSystem& system, const Rows& rows) {
  constexpr double round_off = 1e-13;  // of sums of a few products, in a scaled row
  if (rows.nonZeros() != static_cast<Eigen::Index>(system.values.size())) {
    throw CaseError("the numbers of entries differ");
  }
  for (int row = 0; row < rows.rows(); ++row) {
    std::int64_t e = system.offsets[row];
    for (Rows::InnerIterator entry(rows, row); entry; ++entry, ++e) {
      const double expected = entry.value() * system.row_scales[row];
      if (system.columns[e] == entry.col() && std::abs(system.values[e] - expected) <= round_off) {
        continue;
      }
      throw CaseError(fmt::format("row {}: {} at column {}, expected {} at {}", row,
                                  system.values[e], system.columns[e], expected, entry.col()));
    }
  }
}

/// A case whose assembly is compared with triplets.
template <int Dim>
void add_contest(const std::string& name, Kind kind, int level, int k, bool& failed) {
  const Goal goal{"assembly/" + name, "Eigen triplets", 12, 20};
  add_goal(goal, failed, [kind, level, k] {
    const auto scene = make_scene<Dim>(kind, level, k);
    compare(assembled(*scene), rows_from_triplets(*scene));
    return Contest{[scene] { benchmark::DoNotOptimize(assembled(*scene).values.data()); },
                   [scene] { benchmark::DoNotOptimize(rows_from_triplets(*scene).valuePtr()); },
                   static_cast<double>(scene->cloud.size()), scene->label};
  });
  benchmark::RegisterBenchmark(("reassembly/" + name).c_str(),
                               [kind, level, k, &failed](benchmark::State& state) {
                                 run_guarded(state, failed, [&] {
                                   const auto scene = make_scene<Dim>(kind, level, k);
                                   LinearSystem system = assembled(*scene);
                                   for (auto _ : state) {
                                     reassemble(scene->equations, scene->weights,
                                                {.count = scene->cloud.size()}, system);
                                     benchmark::DoNotOptimize(system.values.data());
                                   }
                                   report_per_node(state, scene->cloud.size(), scene->label);
                                 });
                               })
      ->MeasureProcessCPUTime()
      ->Unit(benchmark::kMillisecond);
}

int run(int argc, char** argv) {
  bool failed = false;
  omp_set_num_threads(1);
  add_contest<2>("poisson_2d", Kind::poisson, 401, 15, failed);
  add_contest<2>("elasticity_2d", Kind::elasticity, 401, 15, failed);
  add_contest<3>("elasticity_3d", Kind::elasticity, 35, 30, failed);
  return run_registered(argc, argv, failed);
}

}  // namespace
}  // namespace strongpoint

int main(int argc, char** argv) { return strongpoint::run(argc, argv); }
