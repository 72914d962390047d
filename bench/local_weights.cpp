#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <omp.h>

#include "bench/local_case.hpp"
#include "bench/report.hpp"
#include "problems/core/jet.hpp"

namespace strongpoint {
namespace {

/// A polynomial of the given degree, 0 to 2, with every monomial.
struct Polynomial {
  int degree;

  template <class T, std::size_t Dim>
  T operator()(const std::array<T, Dim>& x) const {
    T sum = 0.5;
    for (std::size_t c = 0; c < Dim; ++c) sum = sum + (1.0 + static_cast<double>(c)) * x[c];
    if (degree == 0) return T(0.5);
    return degree == 1 ? sum : sum * sum - 3.0 * x[0] * x[Dim - 1];
  }
};

/// Largest error of derivatives of a polynomial that a method declares to reproduce, relative to
/// sum |weight| |value|: round-off when all is well.
template <int Dim>
double reproduction_error(const LocalCase<Dim>& local, const Weights& weights,
                          const Derivatives<Dim>& derivatives) {
  const Polynomial polynomial{std::min(2, local.method->promises().reproduces)};
  if (polynomial.degree < 0) return 0;
  Eigen::VectorXd values(local.cloud.size());
  for (int i = 0; i < values.size(); ++i) {
    values[i] = jets_at<Dim, 0>(polynomial, Point<Dim>(local.cloud.nodes.col(i))).value();
  }
  double worst = 0;
  for (int i = 0; i < weights.size(); ++i) {
    const Point<Dim> x = local.cloud.nodes.col(i);
    const Eigen::VectorXd exact = exact_derivatives<Dim>(polynomial, x, derivatives);
    Eigen::VectorXd sum = -exact;
    Eigen::VectorXd size = exact.cwiseAbs();
    for (int j = 0; const int node : weights.nodes(i)) {
      sum += weights.row(i).col(j) * values[node];
      size += weights.row(i).col(j).cwiseAbs() * std::abs(values[node]);
      ++j;
    }
    const double error = (sum.array().abs() / size.array().max(1e-300)).maxCoeff();
    if (!std::isfinite(error)) return error;
    worst = std::max(worst, error);
  }
  return worst;
}

/// Times the first and second derivatives' weights at every node of a cloud, after checking them.
template <int Dim>
void time_weights(benchmark::State& state, const std::string& spec) {
  // Round-off of local systems of condition 1e4 or so, with room.
  constexpr double largest_error = 1e-9;
  const LocalCase<Dim> local = make_local_case<Dim>(spec, "");
  const auto derivatives = Derivatives<Dim>::between_orders(1, 2);
  const std::string unsupported = local.method->unsupported(derivatives);
  if (!unsupported.empty()) throw SkipCase(unsupported);
  const Weights weights = local.method->weights(local.sites, local.stencils, derivatives);
  const double error = reproduction_error<Dim>(local, weights, derivatives);
  if (!(error <= largest_error)) {
    throw CaseError(fmt::format("polynomials are not reproduced: relative error {:.1e}", error));
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        local.method->weights(local.sites, local.stencils, derivatives).values.data());
  }
  report_per_node(state, local.cloud.size(), local.label());
}

template <int Dim>
void add_benchmark(const std::string& spec, bool& failed) {
  benchmark::RegisterBenchmark(fmt::format("weights/{}/{}d", spec, Dim).c_str(),
                               [spec, &failed](benchmark::State& state) {
                                 run_guarded(state, failed,
                                             [&] { time_weights<Dim>(state, spec); });
                               })
      ->Unit(benchmark::kMillisecond);
}

int run(int argc, char** argv) {
  bool failed = false;
  std::vector<std::string> specs;
  for (const MethodEntry& method : methods()) specs.push_back(method.info.name);
  for (const WeightEntry& weight : weight_functions()) {
    specs.push_back(fmt::format("gfdm[weight={}]", weight.info.name));
  }
  for (const std::string& spec : specs) {
    add_benchmark<2>(spec, failed);
    add_benchmark<3>(spec, failed);
  }
  omp_set_num_threads(1);  // a node's cost, not the machine's width
  return run_registered(argc, argv, failed);
}

}  // namespace
}  // namespace strongpoint

int main(int argc, char** argv) { return strongpoint::run(argc, argv); }
