#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/sites.hpp"
#include "methods/core/stencils.hpp"
#include "methods/core/weights.hpp"

namespace strongpoint {

/// What a method declares of itself; the contract tests check just that.
struct Promises {
  int reproduces = -1;          ///< highest polynomial degree differentiated exactly, -1 for none
  bool scale_covariant = true;  ///< weights of a derivative of order q scale as length^-q
  bool interpolates = true;     ///< nodal parameters are the values at the nodes
  bool local = true;            ///< weights of a point depend on its own stencil only
};

/// How the local matrix is scaled before its condition is judged.
enum class Scaling {
  both,  ///< rows and columns, by the stencil radius: independent of the spacing
  row    ///< rows only, as in thesis (3.26): grows like 1/spacing
};

/// The norm a condition number is measured in.
enum class ConditionNorm { two, one };

/// The stencil of a method whose weights use every node of the cloud: no rule is asked.
inline constexpr const char* every_node = "all";

/// A way to approximate derivatives on scattered nodes.
template <int Dim>
class Method {
 public:
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;
  virtual ~Method() = default;

  /// What has to be prepared beside the nodes.
  virtual Needs needs() const { return {}; }
  virtual Promises promises() const = 0;
  /// Nodes in a stencil when a rule is not told how many, the centre included.
  virtual int stencil_size() const = 0;
  /// The stencil rule this method is run with when none is named; `every_node` with a method that
  /// is not local, whose stencils stay empty.
  virtual std::string default_stencil() const { return "nearest"; }
  /// Why these derivatives cannot be given, in a sentence; empty when they can. Asked for no
  /// derivative at all, why the method does not exist in this dimension.
  virtual std::string unsupported(const Derivatives<Dim>& derivatives) const = 0;
  /// Whether `weights` reads the spans of points, which it may not be given otherwise;
  /// `weights_on` (spans.hpp) serves any method.
  virtual bool reads_spans() const { return false; }
  /// Weights of every evaluation point. Throws CaseError naming the lowest node whose stencil is
  /// degenerate, too small or holds coincident nodes.
  virtual Weights weights(const Sites<Dim>& sites, const Stencils& stencils,
                          const Derivatives<Dim>& derivatives) const = 0;
  /// Condition of the scaled local matrix of each anchor listed, infinite where it is singular;
  /// stencil i belongs to anchors[i].
  virtual std::vector<double> condition(const Sites<Dim>& sites, std::span<const int> anchors,
                                        const Stencils& stencils, Scaling scaling,
                                        ConditionNorm norm) const = 0;
  /// Tells, of each anchor listed, whether its `condition` exceeds a limit or is not a number: 1 or
  /// 0. A method may decide it by bounds.
  virtual std::vector<std::uint8_t> exceeds_condition(const Sites<Dim>& sites,
                                                      std::span<const int> anchors,
                                                      const Stencils& stencils, Scaling scaling,
                                                      ConditionNorm norm, double limit) const {
    const std::vector<double> conditions = condition(sites, anchors, stencils, scaling, norm);
    std::vector<std::uint8_t> exceeds(conditions.size());
    for (std::size_t i = 0; i < exceeds.size(); ++i) exceeds[i] = conditions[i] <= limit ? 0 : 1;
    return exceeds;
  }
  /// The method used at anchors of a zone; itself unless it is zoned.
  virtual const Method& in_zone(Zone) const { return *this; }
};

}  // namespace strongpoint
