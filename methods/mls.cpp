#include "methods/core/moving_fit.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {

/// Moving least squares: derivatives of the shape functions of a polynomial fit whose window moves
/// with the point. Nodal parameters are not values.
/// Source: Lancaster & Salkauskas 1981; thesis 1.3.1, (1.22)-(1.26); what its
/// (1.23) is minimised over is a(x), not p(x). Diffuse derivatives: Nayroles, Touzot, Villon 1992.
/// The thesis gives no window; the quartic spline on 3.2 spacings (degree 2) is the default here.
MethodEntry method_mls() {
  return {{"mls",
           "moving least squares: derivatives of its shape functions",
           {{"degree", "2", "degree of the polynomials, 0 to 8"},
            SmoothingKernel::kernel_option("quartic_spline"),
            suitable_length_option(),
            {"derivatives", "full", "full | diffuse: the window is differentiated or held fixed"}}},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
            const int degree = options.integer("degree", 0, 8);
            const auto differentiation = options.choice<Differentiation>(
                "derivatives",
                {{"full", Differentiation::full}, {"diffuse", Differentiation::diffuse}});
            return make_moving_method<Dim>(
                "mls",
                MovingFit<Dim>(degree, StencilKernel<Dim>(options, suitable_support(Dim, degree)),
                               differentiation, NodeMeasure::one));
          })};
}

}  // namespace strongpoint
