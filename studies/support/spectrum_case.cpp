#include "studies/support/spectrum_case.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "problems/core/integrator.hpp"
#include "studies/support/spectrum_figures.hpp"
#include "studies/support/vtk.hpp"
#include "studies/support/waves.hpp"

namespace strongpoint {
namespace {

using Complex = std::complex<double>;
using Engine = SpectrumOptions::Engine;

constexpr std::array mode_names{"frequency_ratio", "frequency_imaginary", "mode_error"};

/// Modes computed by the engine that does not compute all.
constexpr int lowest = 12;

/// A mode that is judged: its number from 1, and its share of all in per cent.
struct Choice {
  int number;
  double percent;
};

std::vector<Choice> choices_of(const SpectrumOptions& options, int count) {
  std::vector<Choice> choices;
  if (options.shares.empty()) {
    for (int n = 1; n <= count; ++n) choices.push_back({n, 100.0 * n / count});
  }
  for (const double share : options.shares) {
    constexpr double slack = 1e-9;  // a product that is nearly a whole number is one
    choices.push_back({std::max(1, static_cast<int>(share * count + slack)), 100 * share});
  }
  return choices;
}

/// Vibrations u = Re(v exp(i omega t)): omega = sqrt(-lambda).
Eigen::VectorXcd frequencies(const Eigen::VectorXcd& eigenvalues) {
  return (-eigenvalues).cwiseSqrt();
}

/// A mode at the nodes, (fields, N).
template <int Dim>
Eigen::MatrixXcd nodal_mode(const Waves<Dim>& waves, const Eigen::VectorXcd& u) {
  const auto values = [&](const Eigen::VectorXd& part) {
    return solution_of<Dim>(*waves.scene, waves.motion->all_unknowns(part, 0)).fields;
  };
  Eigen::MatrixXcd mode = values(u.real()).template cast<Complex>();
  if (!u.imag().isZero(0)) mode.imag() = values(u.imag());
  return mode;
}

/// A mode times the complex number that brings it nearest to another, (fields, N) each.
Eigen::MatrixXcd fitted(const Eigen::MatrixXcd& mode, const Eigen::MatrixXd& to) {
  const Complex along = mode.conjugate().cwiseProduct(to.cast<Complex>()).sum();
  return along / mode.squaredNorm() * mode;
}

/// A mode whose largest number is 1, for looking at.
Eigen::MatrixXd scaled(const Eigen::MatrixXd& mode) {
  const double largest = mode.cwiseAbs().maxCoeff();
  return largest > 0 ? Eigen::MatrixXd(mode / largest) : mode;
}

/// Everything of one case.
template <int Dim>
struct Run {
  const TransientProblem<Dim>& problem;
  const SpectrumOptions& options;
  Waves<Dim> waves;
  SpectrumFigures figures;
  double node_time = 0;
  std::vector<Quantity> quantities;
  std::vector<NodeArray> arrays;

  std::vector<std::string> columns(const std::string& share, const std::string& mode) const {
    return {figures.complete ? "dense" : "spectra",
            options.time,
            options.damping,
            options.modes,
            share,
            mode};
  }
  void add(const char* name, const Figure& figure) {
    quantities.push_back({name, figure.value, figure.reason, columns("", "")});
  }
};

template <int Dim>
Figure stable_step_of(const Run<Dim>& run) {
  const double step = stable_step(run.options.time, run.figures.radius,
                                  make_damping(run.options.damping), run.node_time);
  if (std::isfinite(step)) return {step, {}};
  return {std::nullopt, "infinite: no step makes a vibration grow"};
}

/// The fastest growth under the integrator at its own step.
template <int Dim>
Figure step_growth_of(const Run<Dim>& run) {
  const TimeSpec time = parse_time(run.options.time);
  const double dt =
      time.courant ? *time.courant * run.node_time : time.dt.value_or(run.problem.time_step());
  std::vector<Complex> values{-run.figures.radius};
  const EigenPairs& pairs = run.figures.complete ? run.figures.modes : run.figures.fastest;
  for (const Complex& lambda : pairs.values) {
    // A conjugate grows the same.
    if (lambda.imag() >= 0 || !run.figures.complete) values.push_back(lambda);
  }
  const Damping damping = make_damping(run.options.damping);
  const Amplification amplification(run.options.time);
  double largest = 0;
  for (const Complex& lambda : values) {
    largest = std::max(largest, amplification(lambda, damping, run.node_time, dt));
  }
  return {std::log(largest) / dt,
          fmt::format("at a step of {:.4g}{}", dt,
                      run.figures.complete ? "" : ", of the fastest growing and the highest")};
}

template <int Dim>
void add_figures(Run<Dim>& run) {
  run.add("spectral_radius", {run.figures.radius, {}});
  run.add("largest_real", run.figures.largest_real);
  run.add("largest_imaginary", run.figures.largest_imaginary);
  run.add("growth_rate", run.figures.growth_rate);
  run.add("stable_step", stable_step_of<Dim>(run));
  run.add("step_growth_rate", step_growth_of<Dim>(run));
  run.add("non_normality", run.figures.non_normality);
  run.add("residual", run.figures.residual);
}

/// The exact mode at the nodes, (fields, N).
template <int Dim>
Eigen::MatrixXd exact_mode(const EigenProblem<Dim>& problem, const PointCloud<Dim>& cloud, int n) {
  Eigen::MatrixXd exact(problem.space().fields().size(), cloud.size());
  for (int i = 0; i < cloud.size(); ++i) exact.col(i) = problem.mode(n, cloud.nodes.col(i));
  return exact;
}

/// Judges the modes chosen, the frequencies in ascending order.
template <int Dim>
void add_modes(Run<Dim>& run, const EigenProblem<Dim>& problem) {
  const Eigen::VectorXcd omega = frequencies(run.figures.modes.values);
  std::vector<Eigen::Index> order(omega.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return omega[a].real() < omega[b].real();
  });
  for (const Choice& choice : choices_of(run.options, run.waves.motion->size())) {
    const int n = choice.number;
    std::array<Figure, mode_names.size()> numbers;
    if (n > omega.size()) {
      numbers.fill({std::nullopt, fmt::format("only the {} lowest modes are computed; ask for "
                                              "--engine dense, or a coarser level",
                                              omega.size())});
    } else {
      const Eigen::Index i = order[n - 1];
      const Eigen::MatrixXd exact = exact_mode<Dim>(problem, run.waves.scene->cloud, n);
      const Eigen::MatrixXcd mode =
          fitted(nodal_mode<Dim>(run.waves, run.figures.modes.vectors.col(i)), exact);
      numbers = {{{omega[i].real() / problem.frequency(n), {}},
                  {std::abs(omega[i].imag()), {}},
                  {(mode - exact.cast<Complex>()).norm() / exact.norm(), {}}}};
      run.arrays.push_back({fmt::format("mode_{}", n), scaled(mode.real())});
      run.arrays.push_back({fmt::format("mode_{}_exact", n), exact});
    }
    for (std::size_t q = 0; q < numbers.size(); ++q) {
      run.quantities.push_back(
          {mode_names[q], numbers[q].value, numbers[q].reason,
           run.columns(fmt::format("{:.10g}", choice.percent), fmt::format("mode_{}", n))});
    }
  }
}

/// The lowest modes and the fastest growing one, for looking at.
template <int Dim>
void add_shapes(Run<Dim>& run) {
  const auto add = [&](const std::string& name, const Eigen::VectorXcd& u) {
    run.arrays.push_back({name, scaled(nodal_mode<Dim>(run.waves, u).real())});
  };
  const EigenPairs& modes = run.figures.modes;
  constexpr Eigen::Index shown = 4;
  for (Eigen::Index i = 0; i < std::min(shown, modes.values.size()); ++i) {
    add(fmt::format("mode_{}", i + 1), modes.vectors.col(i));
  }
  if (run.figures.fastest.values.size() > 0) add("fastest", run.figures.fastest.vectors.col(0));
}

bool takes_dense(Engine engine, int size) {
  return engine == Engine::dense || (engine == Engine::automatic && size <= dense_limit);
}

template <int Dim>
CaseResult run_case(const TransientProblem<Dim>& problem, const CaseKey& key,
                    const RunOptions& options, const SpectrumOptions& spectrum) {
  const StageClock clock(options.threads);
  CaseResult result;
  reset_peak_memory();
  Run<Dim> run{problem, spectrum, make_waves<Dim>(problem, key, options, result.times), {}, 0,
               {},      {}};
  clock.time(result.times.solve, [&] {
    const Motion& motion = *run.waves.motion;
    run.figures = takes_dense(spectrum.engine, motion.size()) ? dense_figures(motion)
                                                              : sparse_figures(motion, lowest);
    run.node_time = node_time<Dim>(problem, run.waves, run.figures.radius);
    add_figures<Dim>(run);
    if (const auto* known = dynamic_cast<const EigenProblem<Dim>*>(&problem)) {
      add_modes<Dim>(run, *known);
    }
  });
  result.times.peak_mb = peak_memory_mb();
  if (options.vtk) {
    if (run.arrays.empty()) add_shapes<Dim>(run);
    write_vtu<Dim>(*options.vtk, key, run.waves.scene->cloud, run.arrays);
  }
  result.quantities = std::move(run.quantities);
  result.nodes = run.waves.scene->cloud.size();
  result.unknowns = run.waves.motion->size();
  result.spacing = run.waves.scene->cloud.spacing();
  return result;
}

}  // namespace

std::vector<std::string> spectrum_quantities(const CaseKey& key, const SpectrumOptions& options) {
  std::vector<std::string> names =
      with_problem<TransientProblem>(key.problem, "transient", [](const auto&) {
        return std::vector<std::string>{"spectral_radius", "largest_real", "largest_imaginary",
                                        "growth_rate",     "stable_step",  "step_growth_rate",
                                        "non_normality",   "residual"};
      });
  if (!is_kind<EigenProblem>(key.problem)) return names;
  const std::size_t modes = std::max<std::size_t>(1, options.shares.size());
  for (std::size_t i = 0; i < modes; ++i) {
    names.insert(names.end(), mode_names.begin(), mode_names.end());
  }
  return names;
}

CaseResult run_spectrum_case(const CaseKey& key, const RunOptions& options,
                             const SpectrumOptions& spectrum) {
  return with_problem<TransientProblem>(key.problem, "transient",
                                        [&]<int Dim>(const TransientProblem<Dim>& problem) {
                                          return run_case<Dim>(problem, key, options, spectrum);
                                        });
}

}  // namespace strongpoint
