#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <benchmark/benchmark.h>
#include <omp.h>

#include "bench/local_case.hpp"
#include "bench/report.hpp"
#include "methods/core/taylor_fit.hpp"

namespace strongpoint {
namespace {

using Matrices = std::vector<Eigen::MatrixXd>;

double largest_column_sum(const Eigen::MatrixXd& matrix) {
  return matrix.cwiseAbs().colwise().sum().maxCoeff();
}

/// A way to judge a matrix.
struct Estimate {
  const char* name;
  double (*condition)(const Eigen::MatrixXd& matrix);
};

/// The 2-norm condition by singular values.
double two_norm_by_svd(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
  return values[0] / values[values.size() - 1];
}

/// The 1-norm condition by the inverse.
double one_norm_by_inverse(const Eigen::MatrixXd& matrix) {
  return largest_column_sum(matrix) *
         largest_column_sum(Eigen::PartialPivLU<Eigen::MatrixXd>(matrix).inverse());
}

/// A lower bound of the 1-norm condition from a factor and a few solves (Hager's and Higham's
/// estimator as in LAPACK).
double one_norm_by_rcond(const Eigen::MatrixXd& matrix) {
  return 1 / Eigen::PartialPivLU<Eigen::MatrixXd>(matrix).rcond();
}

constexpr std::array<Estimate, 3> estimates{{{"two_norm_svd", two_norm_by_svd},
                                             {"one_norm_inverse", one_norm_by_inverse},
                                             {"one_norm_rcond", one_norm_by_rcond}}};

/// The local matrices of the unweighted Taylor fit, scaled on both sides.
template <int Dim>
Matrices taylor_matrices(const LocalCase<Dim>& local, int order) {
  const TaylorFit<Dim> fit(order, make_weight("one").made);
  Matrices matrices;
  LocalStencil<Dim> stencil;
  for (int a = 0; a < local.sites.anchor_count(); ++a) {
    if (stencil.gather(local.sites, local.stencils[a], a) != LocalOutcome::ok) {
      throw CaseError(fmt::format("the stencil of node {} is degenerate", a));
    }
    matrices.push_back(fit.local_matrix(stencil, Scaling::both));
  }
  return matrices;
}

/// Throws when an estimate contradicts the others: the 2-norm against eigenvalues of A^T A, the
/// norms against each other (n cond_1 >= cond_2 >= cond_1 / n), the estimator against what it
/// bounds.
void check_estimates(const Matrices& matrices) {
  // A^T A squares the condition, of which matrices here have at most 1e5.
  constexpr double eigenvalue_error = 1e-5;
  // The estimator bounds from below without a guarantee how closely; farther off is a mistake.
  constexpr double estimator_slack = 20;
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    const Eigen::MatrixXd& matrix = matrices[i];
    const double two = two_norm_by_svd(matrix);
    const double one = one_norm_by_inverse(matrix);
    const double bound = one_norm_by_rcond(matrix);
    const Eigen::VectorXd squares =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix.transpose() * matrix).eigenvalues();
    const double reference = std::sqrt(squares[squares.size() - 1] / squares[0]);
    const auto n = static_cast<double>(matrix.rows());
    const bool two_right = std::abs(two / reference - 1) <= eigenvalue_error;
    const bool norms_right = two <= n * one && one <= n * two;
    const bool bound_right =
        bound <= one * (1 + eigenvalue_error) && bound >= one / estimator_slack;
    if (!(two_right && norms_right && bound_right)) {
      throw CaseError(fmt::format(
          "conditions of matrix {} disagree: 2-norm {:.6g} (by eigenvalues {:.6g}), 1-norm {:.6g}, "
          "estimated {:.6g}",
          i, two, reference, one, bound));
    }
  }
}

/// Times one estimate on ready matrices: factorisation included, the making of the matrix not.
template <int Dim>
void time_estimate(benchmark::State& state, const Estimate& estimate, int order, int k) {
  const std::string stencil = fmt::format("nearest[k={}]", k);
  const auto local = make_local_case<Dim>(fmt::format("mfpm[order={}]", order), stencil);
  const Matrices matrices = taylor_matrices<Dim>(local, order);
  check_estimates(matrices);
  double least_share = std::numeric_limits<double>::infinity();
  for (const Eigen::MatrixXd& matrix : matrices) {
    least_share = std::min(least_share, estimate.condition(matrix) / two_norm_by_svd(matrix));
  }
  // How far below the 2-norm condition an estimate can fall: what it costs to be quick.
  state.counters["least_share"] = least_share;
  for (auto _ : state) {
    for (const Eigen::MatrixXd& matrix : matrices) {
      benchmark::DoNotOptimize(estimate.condition(matrix));
    }
  }
  report_per_node(state, local.cloud.size(), local.label());
}

/// Times what a stencil rule asks of a method: gathering, the local matrix and its condition.
template <int Dim>
void time_method(benchmark::State& state, const std::string& spec, ConditionNorm norm) {
  const auto local = make_local_case<Dim>(spec, "");
  std::vector<int> anchors(local.sites.anchor_count());
  std::iota(anchors.begin(), anchors.end(), 0);
  const auto judge = [&] {
    return local.method->condition(local.sites, anchors, local.stencils, Scaling::both, norm);
  };
  for (const double condition : judge()) {
    if (!(condition >= 1 && std::isfinite(condition))) {
      throw CaseError(fmt::format("a condition of {} is impossible on this cloud", condition));
    }
  }
  for (auto _ : state) benchmark::DoNotOptimize(judge().data());
  report_per_node(state, local.cloud.size(), local.label());
}

template <int Dim>
void add_estimates(int order, int k, bool& failed) {
  for (const Estimate& estimate : estimates) {
    benchmark::RegisterBenchmark(
        fmt::format("estimate/{}/order:{}/k:{}/{}d", estimate.name, order, k, Dim).c_str(),
        [estimate, order, k, &failed](benchmark::State& state) {
          run_guarded(state, failed, [&] { time_estimate<Dim>(state, estimate, order, k); });
        })
        ->Unit(benchmark::kMillisecond);
  }
}

template <int Dim>
void add_method(const std::string& spec, bool& failed) {
  for (const auto& [name, norm] :
       {std::pair{"two", ConditionNorm::two}, std::pair{"one", ConditionNorm::one}}) {
    benchmark::RegisterBenchmark(fmt::format("method/{}/{}_norm/{}d", spec, name, Dim).c_str(),
                                 [spec, norm = norm, &failed](benchmark::State& state) {
                                   run_guarded(state, failed,
                                               [&] { time_method<Dim>(state, spec, norm); });
                                 })
        ->Unit(benchmark::kMillisecond);
  }
}

int run(int argc, char** argv) {
  bool failed = false;
  add_estimates<2>(2, 9, failed);
  add_estimates<2>(2, 15, failed);
  add_estimates<2>(3, 25, failed);
  add_estimates<3>(2, 30, failed);
  for (const MethodEntry& method : methods()) {
    add_method<2>(method.info.name, failed);
    add_method<3>(method.info.name, failed);
  }
  omp_set_num_threads(1);  // a node's cost, not the machine's width
  return run_registered(argc, argv, failed);
}

}  // namespace
}  // namespace strongpoint

int main(int argc, char** argv) { return strongpoint::run(argc, argv); }
