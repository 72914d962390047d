#include <array>

#include "methods/core/local_method.hpp"
#include "methods/core/radial_derivative.hpp"
#include "methods/core/registry.hpp"
#include "methods/core/stencil_kernel.hpp"

namespace strongpoint {
namespace {

/// The kernel estimate as a sum over cells; nothing is solved.
template <int Dim>
class KernelEstimate {
 public:
  struct Workspace {
    std::vector<const RadialDerivative<Dim>*> radial;
  };

  explicit KernelEstimate(StencilKernel<Dim> kernel)
      : kernel_(std::move(kernel)),
        offered_(Derivatives<Dim>::between_orders(0, kernel_.kernel().smoothness())) {
    for (const MultiIndex<Dim>& alpha : offered_) radial_.emplace_back(alpha);
  }

  int needed_nodes() const { return 1; }
  LocalOutcome factorise(const LocalStencil<Dim>&, Workspace&) const { return LocalOutcome::ok; }
  void evaluate(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
                const Derivatives<Dim>& derivatives, Eigen::Map<Eigen::MatrixXd> weights) const {
    work.radial.clear();
    for (const MultiIndex<Dim>& alpha : derivatives) {
      work.radial.push_back(&radial_[offered_.index(alpha)]);
    }
    const double length = kernel_.length(stencil);
    std::array<double, most_smoothness + 1> f{};
    for (int j = 0; j < stencil.size; ++j) {
      const Point<Dim> q = (offset - stencil.node(j)) / length;
      kernel_.kernel().evaluate(q.squaredNorm(), derivatives.highest_order(), f.data());
      for (int d = 0; d < derivatives.size(); ++d) {
        weights(d, j) = stencil.volumes[j] * (*work.radial[d])(q, f.data()) *
                        std::pow(length, -Dim - order_of<Dim>(derivatives[d]));
      }
    }
  }
  Eigen::MatrixXd local_matrix(const LocalStencil<Dim>&, Scaling) const {
    return Eigen::MatrixXd::Identity(1, 1);
  }
  std::string unsupported(const Derivatives<Dim>& derivatives) const {
    for (const MultiIndex<Dim>& alpha : derivatives) {
      if (!offered_.contains(alpha)) {
        return fmt::format("the kernel is smooth to order {} only and cannot give {}",
                           kernel_.kernel().smoothness(), name_of<Dim>(alpha));
      }
    }
    return {};
  }

 private:
  StencilKernel<Dim> kernel_;
  Derivatives<Dim> offered_;
  std::vector<RadialDerivative<Dim>> radial_;
};

}  // namespace

/// Smoothed Particle Hydrodynamics: D^a f(x) = sum_j V_j f_j D^a W(x - x_j), which is (1.9) of the
/// thesis with its (-1)^n taken into the kernel's argument. The cells are Voronoi's. Exact for no
/// polynomial, and not convergent on irregular nodes or near boundaries. Source: Lucy 1977; Gingold
/// & Monaghan 1977; thesis (1.8)-(1.10).
MethodEntry method_sph() {
  return {{"sph",
           "Smoothed Particle Hydrodynamics: sums of kernel derivatives over the cells",
           {SmoothingKernel::kernel_option("gauss"), SmoothingKernel::length_option("1.2")}},
          in_every_dimension<Method>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<Method<Dim>> {
                using Made = LocalMethod<Dim, KernelEstimate<Dim>>;
                const StencilKernel<Dim> kernel(options);
                return std::make_unique<Made>(
                    KernelEstimate<Dim>(kernel),
                    typename Made::Traits{"sph",
                                          {.reproduces = -1, .interpolates = false},
                                          {.volumes = true, .spacing = true},
                                          StencilKernel<Dim>::least_nodes,
                                          kernel.default_stencil()});
              })};
}

}  // namespace strongpoint
