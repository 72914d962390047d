#include "studies/support/waves.hpp"

#include <cmath>
#include <optional>

#include "problems/core/assembly.hpp"

namespace strongpoint {
namespace {

/// Rows that give the value of every unknown, where the weights hold it.
template <int Dim>
std::optional<LinearSystem> value_rows(const Discretisation<Dim>& scene, int fields) {
  const MultiIndex<Dim> value{};
  if (!scene.derivatives.contains(value)) return std::nullopt;
  EquationList list;
  EquationWriter<Dim> write(list, scene.derivatives);
  for (int node = 0; node < scene.unknowns.count; ++node) {
    for (int f = 0; f < fields; ++f) {
      write.at(node);
      if (node < scene.cloud.size()) {
        write.add(f, value, 1);
      } else {
        write.add_unknown(node, f, 1);  // a ghost has no value of its own
      }
      write.equals(0);
    }
  }
  return assemble(list, scene.weights, scene.unknowns, fields);
}

/// The spacing of a structured cloud that is the same along all axes.
template <int Dim>
std::optional<double> common_spacing(const PointCloud<Dim>& cloud) {
  if (!cloud.block) return std::nullopt;
  constexpr double tolerance = 1e-9;
  const double h = (cloud.nodes.col(1) - cloud.nodes.col(0)).norm();
  int stride = 1;
  for (int c = Dim - 1; c >= 0; --c) {
    const int count = cloud.block->shape[c];
    for (int node = 0; node < cloud.size(); ++node) {
      if (node / stride % count == count - 1) continue;
      const double step = (cloud.nodes.col(node + stride) - cloud.nodes.col(node)).norm();
      if (std::abs(step - h) > tolerance * h) return std::nullopt;
    }
    stride *= count;
  }
  return h;
}

}  // namespace

template <int Dim>
Waves<Dim> make_waves(const TransientProblem<Dim>& problem, const CaseKey& key,
                      const RunOptions& options, StageTimes& times) {
  const StageClock clock(options.threads);
  Waves<Dim> waves;
  waves.scene = discretise<Dim>(problem.space(), key, options, times);
  const Discretisation<Dim>& scene = *waves.scene;
  const int fields = static_cast<int>(problem.space().fields().size());
  EquationList equations;
  std::optional<LinearSystem> values;
  clock.time(times.assemble, [&] {
    equations = scene.equations(scene.derivatives);
    waves.system = assemble(equations, scene.weights, scene.unknowns, fields);
    values = value_rows<Dim>(scene, fields);
  });
  clock.time(times.solve, [&] {
    std::vector<double> inertia(equations.size());
    for (int row = 0; row < equations.size(); ++row) inertia[row] = equations.inertia_of(row);
    waves.motion =
        std::make_unique<CondensedMotion>(waves.system, inertia, values ? &*values : nullptr);
  });
  return waves;
}

template <int Dim>
double node_time(const TransientProblem<Dim>& problem, const Waves<Dim>& waves,
                 double spectral_radius) {
  const std::optional<double> h = common_spacing<Dim>(waves.scene->cloud);
  return h ? *h / problem.wave_speed() : 2 / std::sqrt(spectral_radius);
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same for each dimension */                            \
  template Waves<Dim> make_waves(const TransientProblem<Dim>&, const CaseKey&, const RunOptions&, \
                                 StageTimes&);                                                    \
  template double node_time(const TransientProblem<Dim>&, const Waves<Dim>&, double)
STRONGPOINT_INSTANTIATE(1);
STRONGPOINT_INSTANTIATE(2);
STRONGPOINT_INSTANTIATE(3);
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
