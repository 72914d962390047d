#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "methods/core/condition.hpp"
#include "methods/core/error.hpp"
#include "methods/core/local_stencil.hpp"
#include "methods/core/method.hpp"
#include "methods/core/parallel_errors.hpp"
#include "methods/core/spans.hpp"
#include "methods/core/stencil_batch.hpp"
#include "methods/core/stencil_weights.hpp"

namespace strongpoint {

/// What a kernel offers: factorise the local system of a stencil, then evaluate derivatives of the
/// local approximation anywhere near it, all in scaled coordinates. `evaluate` returns nothing, or
/// a LocalOutcome where some points cannot be served.
template <class Kernel, int Dim>
concept LocalKernel = requires(const Kernel kernel, const LocalStencil<Dim>& stencil,
                               typename Kernel::Workspace& work, const Point<Dim>& offset,
                               const Derivatives<Dim>& derivatives,
                               Eigen::Map<Eigen::MatrixXd> weights, Scaling scaling) {
  { kernel.needed_nodes() } -> std::same_as<int>;
  { kernel.factorise(stencil, work) } -> std::same_as<LocalOutcome>;
  {kernel.evaluate(stencil, work, offset, derivatives, weights)};
  { kernel.local_matrix(stencil, scaling) } -> std::same_as<Eigen::MatrixXd>;
  { kernel.unsupported(derivatives) } -> std::same_as<std::string>;
};

/// A kernel that computes many stencils faster than one after the other. `fill_batch` writes the
/// weights of all points of the anchors it can serve, in the units of the sites, and sets
/// outcomes[i] of anchors[i]: ok, or undecided where the stencil has to be treated on its own (ill
/// conditioned, of a size of its own, faulty). What an anchor gets must not depend on the others.
template <class Kernel, int Dim>
concept BatchKernel = LocalKernel<Kernel, Dim> &&
    requires(const Kernel kernel, const StencilBatch<Dim>& batch, typename Kernel::Workspace& work,
             Weights& weights, std::span<LocalOutcome> outcomes) {
  {kernel.fill_batch(batch, work, weights, outcomes)};
};

/// A kernel that bounds the conditions of many local matrices faster than it finds one of them.
/// `bound_conditions` fills, for stencil i of anchors[i], bounds that hold to 1e-6 or better, 0 and
/// infinity where it cannot tell; `first` is the stencil of the first anchor.
template <class Kernel, int Dim>
concept ConditionBoundsKernel = LocalKernel<Kernel, Dim> &&
    requires(const Kernel kernel, const Sites<Dim>& sites, std::span<const int> anchors,
             const Stencils& stencils, int first, Scaling scaling, ConditionNorm norm,
             typename Kernel::Workspace& work, std::span<ConditionBounds> bounds) {
  {kernel.bound_conditions(sites, anchors, stencils, first, scaling, norm, work, bounds)};
};

/// A kernel whose `fill_batch` averages over the spans of points.
template <class Kernel>
concept SpanKernel = requires {
  requires Kernel::reads_spans;
};

/// A method whose weights come from a kernel, stencil by stencil: a static loop over the anchors,
/// parallel, with one workspace a thread and no allocation once the workspaces have grown.
template <int Dim, class Kernel>
requires LocalKernel<Kernel, Dim>
class LocalMethod : public Method<Dim> {
 public:
  /// What stays the same for all kernels of one method.
  struct Traits {
    std::string name;  ///< for messages
    Promises promises;
    Needs needs;
    int stencil_size;
    std::string default_stencil = "nearest";
  };

  LocalMethod(Kernel kernel, Traits traits)
      : kernel_(std::move(kernel)), traits_(std::move(traits)) {}

  const Kernel& kernel() const { return kernel_; }
  Needs needs() const override { return traits_.needs; }
  Promises promises() const override { return traits_.promises; }
  int stencil_size() const override { return traits_.stencil_size; }
  std::string default_stencil() const override { return traits_.default_stencil; }
  std::string unsupported(const Derivatives<Dim>& derivatives) const override {
    return kernel_.unsupported(derivatives);
  }
  bool reads_spans() const override { return SpanKernel<Kernel>; }
  Weights weights(const Sites<Dim>& sites, const Stencils& stencils,
                  const Derivatives<Dim>& derivatives) const override;
  std::vector<double> condition(const Sites<Dim>& sites, std::span<const int> anchors,
                                const Stencils& stencils, Scaling scaling,
                                ConditionNorm norm) const override;
  std::vector<std::uint8_t> exceeds_condition(const Sites<Dim>& sites, std::span<const int> anchors,
                                              const Stencils& stencils, Scaling scaling,
                                              ConditionNorm norm, double limit) const override;

 private:
  Kernel kernel_;
  Traits traits_;

  /// Throws CaseError when something that the method needs was not prepared.
  void check_needs(const Sites<Dim>& sites) const {
    if (traits_.needs.volumes && sites.volumes.size() != sites.node_count()) {
      throw CaseError(traits_.name + ": cell volumes are needed but the sites hold none");
    }
    if (traits_.needs.spacing && sites.spacing.size() != sites.anchor_count()) {
      throw CaseError(traits_.name + ": the local spacing is needed but the sites hold none");
    }
    if (traits_.needs.block && !sites.block) {
      throw CaseError(traits_.name + ": an index block is needed but the sites hold none");
    }
  }
  /// Anchors handed to a thread, and to a kernel's batch, at a time.
  static constexpr int block_size = 64;

  /// Writes the weights at a place, in units of the stencil radius, the anchor being the origin.
  LocalOutcome evaluate(const LocalStencil<Dim>& local, typename Kernel::Workspace& work,
                        const Point<Dim>& offset, const Derivatives<Dim>& derivatives,
                        Eigen::Map<Eigen::MatrixXd> row) const {
    using Evaluated = decltype(kernel_.evaluate(local, work, offset, derivatives, row));
    if constexpr (std::is_void_v<Evaluated>) {
      kernel_.evaluate(local, work, offset, derivatives, row);
      return LocalOutcome::ok;
    } else {
      return kernel_.evaluate(local, work, offset, derivatives, row);
    }
  }
  /// Writes the weights of all points of one anchor.
  LocalOutcome fill(const Sites<Dim>& sites, const Stencils& stencils, int anchor,
                    std::span<const int> points, const Derivatives<Dim>& derivatives,
                    LocalStencil<Dim>& local, typename Kernel::Workspace& work,
                    Weights& weights) const;
};

template <int Dim, class Kernel>
requires LocalKernel<Kernel, Dim> LocalOutcome LocalMethod<Dim, Kernel>::fill(
    const Sites<Dim>& sites, const Stencils& stencils, int anchor, std::span<const int> points,
    const Derivatives<Dim>& derivatives, LocalStencil<Dim>& local, typename Kernel::Workspace& work,
    Weights& weights)
const {
  LocalOutcome outcome = local.gather(sites, stencils[anchor], anchor);
  if (outcome == LocalOutcome::ok) outcome = kernel_.factorise(local, work);
  if (outcome != LocalOutcome::ok) return outcome;
  Eigen::MatrixXd at_one_end;  // of as many numbers at each point
  for (int p : points) {
    const Point<Dim> offset = (sites.points.col(p) - sites.anchors.col(anchor)) / local.radius;
    Eigen::Map<Eigen::MatrixXd> row = weights.row(p);
    if (sites.spans.cols() == 0) {
      outcome = evaluate(local, work, offset, derivatives, row);
    } else {
      const Point<Dim> span = sites.spans.col(p) / local.radius;
      outcome = evaluate(local, work, offset - span, derivatives, row);
      at_one_end = row;
      if (outcome == LocalOutcome::ok) {
        outcome = evaluate(local, work, offset + span, derivatives, row);
      }
      row = 0.5 * (row + at_one_end);
    }
    if (outcome != LocalOutcome::ok) return outcome;
    for (int d = 0; d < derivatives.size(); ++d) {
      row.row(d) *= std::pow(local.radius, -order_of<Dim>(derivatives[d]));
    }
    if (!row.allFinite()) return LocalOutcome::not_finite;
  }
  return LocalOutcome::ok;
}

template <int Dim, class Kernel>
requires LocalKernel<Kernel, Dim> Weights LocalMethod<Dim, Kernel>::weights(
    const Sites<Dim>& sites, const Stencils& stencils, const Derivatives<Dim>& derivatives)
const {
  check_needs(sites);
  if (!reads_spans()) refuse_spans<Dim>(sites, traits_.name);
  Weights weights = weights_on_stencils(sites, stencils, derivatives.size());
  const Stencils points = points_by_anchor(sites);
  const std::vector<int> anchors = stencils.occupied();
  const int count = static_cast<int>(anchors.size());
  std::vector<LocalOutcome> outcomes(anchors.size(), LocalOutcome::undecided);
  ParallelErrors errors;
#pragma omp parallel
  {
    LocalStencil<Dim> local;
    typename Kernel::Workspace work;
#pragma omp for schedule(dynamic)
    for (int begin = 0; begin < count; begin += block_size) {
      const auto size = static_cast<std::size_t>(std::min(block_size, count - begin));
      const std::span block(anchors.data() + begin, size);
      const std::span results(outcomes.data() + begin, size);
      errors.guard(begin, [&] {
        if constexpr (BatchKernel<Kernel, Dim>) {
          kernel_.fill_batch({sites, stencils, points, derivatives, block}, work, weights, results);
        }
        for (std::size_t i = 0; i < size; ++i) {
          if (results[i] != LocalOutcome::undecided) continue;
          results[i] =
              fill(sites, stencils, block[i], points[block[i]], derivatives, local, work, weights);
        }
      });
    }
  }
  errors.rethrow();
  throw_first_failure(sites, stencils, anchors, outcomes, traits_.name, kernel_.needed_nodes());
  return weights;
}

template <int Dim, class Kernel>
requires LocalKernel<Kernel, Dim> std::vector<double> LocalMethod<Dim, Kernel>::condition(
    const Sites<Dim>& sites, std::span<const int> anchors, const Stencils& stencils,
    Scaling scaling, ConditionNorm norm)
const {
  check_needs(sites);
  std::vector<double> result(anchors.size());
  ParallelErrors errors;
#pragma omp parallel
  {
    LocalStencil<Dim> local;
#pragma omp for schedule(dynamic, 64)
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      errors.guard(static_cast<std::int64_t>(i), [&] {
        const LocalOutcome outcome = local.gather(sites, stencils[static_cast<int>(i)], anchors[i]);
        const bool usable = outcome == LocalOutcome::ok;
        result[i] = condition_number(
            usable ? kernel_.local_matrix(local, scaling) : Eigen::MatrixXd::Zero(1, 1), norm);
      });
    }
  }
  errors.rethrow();
  return result;
}

template <int Dim, class Kernel>
requires LocalKernel<Kernel, Dim> std::vector<std::uint8_t>
LocalMethod<Dim, Kernel>::exceeds_condition(const Sites<Dim>& sites, std::span<const int> anchors,
                                            const Stencils& stencils, Scaling scaling,
                                            ConditionNorm norm, double limit)
const {
  if constexpr (!ConditionBoundsKernel<Kernel, Dim>) {
    return Method<Dim>::exceeds_condition(sites, anchors, stencils, scaling, norm, limit);
  } else {
    check_needs(sites);
    const int count = static_cast<int>(anchors.size());
    std::vector<std::uint8_t> exceeds(anchors.size());
    ParallelErrors errors;
#pragma omp parallel
    {
      LocalStencil<Dim> local;
      typename Kernel::Workspace work;
      std::array<ConditionBounds, block_size> bounds;
#pragma omp for schedule(dynamic)
      for (int begin = 0; begin < count; begin += block_size) {
        const int size = std::min(block_size, count - begin);
        errors.guard(begin, [&] {
          kernel_.bound_conditions(sites, anchors.subspan(begin, size), stencils, begin, scaling,
                                   norm, work, std::span(bounds.data(), size));
          for (int i = 0; i < size; ++i) {
            const int place = begin + i;
            if (bounds[i].upper * (1 + bounds_error) <= limit) {
              exceeds[place] = 0;
            } else if (bounds[i].lower * (1 - bounds_error) > limit) {
              exceeds[place] = 1;
            } else {
              const auto outcome = local.gather(sites, stencils[place], anchors[place]);
              exceeds[place] =
                  outcome == LocalOutcome::ok &&
                          condition_number(kernel_.local_matrix(local, scaling), norm) <= limit
                      ? 0
                      : 1;
            }
          }
        });
      }
    }
    errors.rethrow();
    return exceeds;
  }
}

}  // namespace strongpoint
