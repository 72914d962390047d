#pragma once

#include "methods/core/derivatives.hpp"
#include "methods/core/points.hpp"
#include "problems/core/equation.hpp"

namespace strongpoint {

/// Constants of an isotropic linear elastic material, in units of stress. Source: thesis (4.3).
struct Lame {
  double lambda, mu;
};

/// Gradients of the Lame constants, stress over length.
template <int Dim>
struct LameGradient {
  Point<Dim> lambda = Point<Dim>::Zero();
  Point<Dim> mu = Point<Dim>::Zero();
};

/// Lame constants from Young's modulus and Poisson's ratio (plane strain in 2D).
inline Lame lame_constants(double young, double poisson) {
  return {young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))};
}

/// The derivative d/dx_i, or d2/dx_i dx_j.
template <int Dim>
MultiIndex<Dim> partial(int i, int j = -1) {
  MultiIndex<Dim> alpha{};
  for (int c = 0; c < Dim; ++c) alpha[c] = (c == i ? 1 : 0) + (c == j ? 1 : 0);
  return alpha;
}

/// Adds component i of div sigma: mu lap u_i + (lambda + mu) d_i div u. Fields are the
/// displacements. Source: thesis (4.4).
template <int Dim>
void add_equilibrium(EquationWriter<Dim>& write, const Lame& material, int i) {
  for (int j = 0; j < Dim; ++j) {
    const double own = i == j ? material.lambda + 2 * material.mu : material.mu;
    write.add(i, partial<Dim>(j, j), own);
    if (i != j) write.add(j, partial<Dim>(i, j), material.lambda + material.mu);
  }
}

/// Adds component i of share * grad lambda div u + 2 eps grad mu, what equilibrium has beside the
/// above where the material varies. Source: thesis (4.21), corrected: the strain is doubled.
template <int Dim>
void add_gradient_terms(EquationWriter<Dim>& write, const LameGradient<Dim>& gradient, double share,
                        int i) {
  for (int j = 0; j < Dim; ++j) {
    write.add(j, partial<Dim>(j), share * gradient.lambda[i]);
    write.add(i, partial<Dim>(j), gradient.mu[j]);
    write.add(j, partial<Dim>(i), gradient.mu[j]);
  }
}

/// Adds m . sigma n, the component along m of the traction on a face with normal n.
template <int Dim>
void add_traction(EquationWriter<Dim>& write, const Lame& material, const Point<Dim>& m,
                  const Point<Dim>& n) {
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) {
      const double diagonal = i == j ? material.lambda * m.dot(n) : 0;
      const double coefficient = diagonal + material.mu * (m[i] * n[j] + m[j] * n[i]);
      if (coefficient != 0) write.add(i, partial<Dim>(j), coefficient);
    }
  }
}

/// Stress tensor from the displacement gradient, gradient(i, j) = d u_i / d x_j. Source: thesis
/// (4.2).
template <int Dim>
Eigen::Matrix<double, Dim, Dim> stress(const Lame& material,
                                       const Eigen::Matrix<double, Dim, Dim>& gradient) {
  return material.lambda * gradient.trace() * Eigen::Matrix<double, Dim, Dim>::Identity() +
         material.mu * (gradient + gradient.transpose());
}

}  // namespace strongpoint
