#include "studies/support/discretise.hpp"

#include <omp.h>

#include "methods/core/neighbours.hpp"
#include "methods/core/spacing.hpp"
#include "methods/core/spans.hpp"
#include "problems/core/layout.hpp"
#include "problems/core/visibility.hpp"
#include "problems/core/voronoi.hpp"
#include "studies/support/part_stages.hpp"

extern "C" {
/// Present when UMFPACK's BLAS is OpenBLAS.
void openblas_set_num_threads(int threads) __attribute__((weak));
}

namespace strongpoint {
namespace {

/// Adds the time spent inside the search engine to `seconds`.
template <int Dim>
class TimedSearch final : public NeighbourSearch<Dim> {
 public:
  TimedSearch(const NeighbourSearch<Dim>& inner, const StageClock& clock, double& seconds)
      : inner_(inner), clock_(clock), seconds_(seconds) {}
  Stencils nearest(const Points<Dim>& queries, int k, Ties ties) const override {
    return clock_.time(seconds_, [&] { return inner_.nearest(queries, k, ties); });
  }
  Stencils within(const Points<Dim>& queries, std::span<const double> radii) const override {
    return clock_.time(seconds_, [&] { return inner_.within(queries, radii); });
  }

 private:
  const NeighbourSearch<Dim>& inner_;
  const StageClock& clock_;
  double& seconds_;
};

void set_threads(const RunOptions& options) {
  omp_set_num_threads(options.threads);
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
}

/// Cell volumes of all nodes of the sites; a mirror image has that of its node.
template <int Dim>
Eigen::VectorXd cell_volumes(const Discretisation<Dim>& scene, const Domain<Dim>& domain,
                             const NeighbourSearch<Dim>& engine, const RunOptions& options) {
  const int count = scene.cloud.size();
  if (scene.unknowns.count > count) {
    throw SkipCase("the method needs cell volumes, which ghost nodes have none of");
  }
  if (scene.sites.node_count() == count) return voronoi_volumes<Dim>(scene.cloud, domain, engine);
  const auto search = make_search<Dim>(options.neighbours, scene.cloud.nodes);
  Eigen::VectorXd volumes = voronoi_volumes<Dim>(scene.cloud, domain, *search);
  volumes.conservativeResize(scene.sites.node_count());
  for (int node = count; node < scene.sites.node_count(); ++node) {
    volumes[node] = volumes[scene.unknowns.source[node]];
  }
  return volumes;
}

template <int Dim>
std::vector<int> field_axes(const SteadyProblem<Dim>& problem) {
  std::vector<int> axes;
  for (int f = 0; f < static_cast<int>(problem.fields().size()); ++f) {
    axes.push_back(problem.vector_axis(f));
  }
  return axes;
}

}  // namespace

template <int Dim>
PointCloud<Dim> make_case_cloud(const Domain<Dim>& domain, const CaseKey& key,
                                const RunOptions& options) {
  return make_cloud<Dim>(domain, key.cloud, LayoutRequest{key.level, options.seed});
}

template <int Dim>
void choose_stencils(Discretisation<Dim>& scene, const Domain<Dim>& domain,
                     const Choices<Dim>& choices, const RunOptions& options,
                     const StageClock& clock, StageTimes& times) {
  if (has_parts(scene)) {
    walk_parts<Dim>(scene, domain, choices, options, clock, times, Upto::stencils);
    return;
  }
  if (const std::string why = choices.method->unsupported(scene.derivatives); !why.empty()) {
    throw SkipCase(why);
  }
  const Needs needs = choices.method->needs() | (choices.rule ? choices.rule->needs() : Needs{});
  if (choices.method->needs().block && !scene.sites.block) {
    throw SkipCase(
        "the method needs a structured cloud (grid, perturbed, graded, blocks) to which the form "
        "adds no nodes (ghosts, mirror images)");
  }
  const auto engine = clock.time(
      times.neighbours, [&] { return make_search<Dim>(options.neighbours, scene.sites.nodes); });
  if (needs.volumes) {
    double seconds = 0;
    scene.sites.volumes =
        clock.time(seconds, [&] { return cell_volumes<Dim>(scene, domain, *engine, options); });
    times.voronoi += seconds;
    times.prepare += seconds;
  }
  if (needs.spacing) {
    scene.sites.spacing = clock.time(times.neighbours, [&] {
      return local_spacing<Dim>(scene.sites.anchors, scene.sites.nodes, *engine);
    });
  }
  if (choices.rule) {
    if (needs.sight) scene.sites.sees = sight_in<Dim>(domain);
    double searching = 0;
    double selecting = 0;
    const TimedSearch<Dim> search(*engine, clock, searching);
    scene.stencils = clock.time(selecting, [&] {
      return select_stencils<Dim>(*choices.rule, scene.sites, *choices.method, search);
    });
    times.neighbours += searching;
    times.stencils += selecting - searching;
    scene.sites.sees = nullptr;  // the scene may outlive the domain
  }
}

template <int Dim>
void compute_weights(Discretisation<Dim>& scene, const Domain<Dim>& domain,
                     const Choices<Dim>& choices, const RunOptions& options,
                     const StageClock& clock, StageTimes& times) {
  if (has_parts(scene)) {
    walk_parts<Dim>(scene, domain, choices, options, clock, times, Upto::weights);
    return;
  }
  choose_stencils<Dim>(scene, domain, choices, options, clock, times);
  scene.weights = clock.time(times.weights, [&] {
    return weights_on(*choices.method, scene.sites, scene.stencils, scene.derivatives);
  });
}

template <int Dim>
std::unique_ptr<Discretisation<Dim>> discretise(const SteadyProblem<Dim>& problem,
                                                const CaseKey& key, const RunOptions& options,
                                                StageTimes& times, Upto upto) {
  set_threads(options);
  const StageClock clock(options.threads);
  const Choices<Dim> choices(key);
  const std::unique_ptr<Form<Dim>> form = make_form<Dim>(key.form);
  if (const std::string why = form->unsupported(problem, *choices.method); !why.empty()) {
    throw SkipCase(why);
  }
  auto made = std::make_unique<Discretisation<Dim>>();  // the equations refer to its cloud
  Discretisation<Dim>& scene = *made;
  scene.cloud =
      clock.time(times.cloud, [&] { return make_case_cloud<Dim>(problem.domain(), key, options); });
  if (!scene.cloud.parts.empty() && !form->joins_parts()) {
    throw SkipCase("the form does not join blocks or patches; take collocation with its defaults");
  }
  clock.time(times.prepare, [&] {
    Plan<Dim> plan = form->plan(problem, scene.cloud, *choices.method);
    scene.derivatives = plan.derivatives;
    scene.derivatives.merge(problem.measured_derivatives());
    scene.sites = std::move(plan.sites);
    scene.unknowns = std::move(plan.unknowns);
    scene.unknowns.field_axis = field_axes(problem);
    scene.unknowns.numbers = scene.cloud.numbers;
    scene.equations = std::move(plan.equations);
  });
  const auto& advance = upto == Upto::weights ? compute_weights<Dim> : choose_stencils<Dim>;
  advance(scene, problem.domain(), choices, options, clock, times);
  return made;
}

template <int Dim>
using ScenePointer = std::unique_ptr<Discretisation<Dim>>;

#define STRONGPOINT_INSTANTIATE(Dim) /* the same for each dimension */                             \
  template PointCloud<Dim> make_case_cloud(const Domain<Dim>&, const CaseKey&, const RunOptions&); \
  template void choose_stencils(Discretisation<Dim>&, const Domain<Dim>&, const Choices<Dim>&,     \
                                const RunOptions&, const StageClock&, StageTimes&);                \
  template void compute_weights(Discretisation<Dim>&, const Domain<Dim>&, const Choices<Dim>&,     \
                                const RunOptions&, const StageClock&, StageTimes&);                \
  template ScenePointer<Dim> discretise(const SteadyProblem<Dim>&, const CaseKey&,                 \
                                        const RunOptions&, StageTimes&, Upto)
STRONGPOINT_INSTANTIATE(1);
STRONGPOINT_INSTANTIATE(2);
STRONGPOINT_INSTANTIATE(3);
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
