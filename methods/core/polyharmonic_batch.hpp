#pragma once

#include <span>
#include <vector>

#include "methods/core/derivatives.hpp"
#include "methods/core/local_method.hpp"
#include "methods/core/simd/lane_array.hpp"
#include "methods/core/simd/polyharmonic_kernel.hpp"

namespace strongpoint {

/// Polyharmonic weights of many stencils side by side: what the kernel `polyharmonic_weights` needs
/// beside the stencils, and the storage of one thread.
template <int Dim>
class PolyharmonicBatch {
 public:
  /// Makes everything ready that depends on the functions and derivatives alone; nothing is done
  /// when the derivatives are those of the last call.
  void prepare(int phs, const Derivatives<Dim>& monomials, const Derivatives<Dim>& derivatives);
  /// Writes the weights of all points of the anchors that can be served, stencils of one size at a
  /// time, and sets their outcomes to ok.
  void fill(const StencilBatch<Dim>& batch, Weights& weights, std::span<LocalOutcome> outcomes);

 private:
  PolyharmonicTask task_{};
  Derivatives<Dim> prepared_;
  std::vector<int> exponents_;         ///< (Dim, m) of the monomials
  std::vector<int> orders_;            ///< (Dim, D) of the derivatives
  std::vector<double> factors_;        ///< (m, D) of the monomials' derivatives
  std::vector<RadialTerm> radial_;     ///< terms of the derivatives of r^phs
  std::vector<int> radial_offsets_;    ///< (D + 1)
  std::vector<int> order_;             ///< positions in a batch, by stencil size
  std::vector<int> chosen_;            ///< anchors of one size
  std::vector<unsigned char> served_;  ///< of these
  LaneArray room_;
};

extern template class PolyharmonicBatch<1>;
extern template class PolyharmonicBatch<2>;
extern template class PolyharmonicBatch<3>;

}  // namespace strongpoint
