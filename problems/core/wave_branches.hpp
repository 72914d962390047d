#pragma once

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "problems/core/symbol.hpp"

namespace strongpoint {

/// A wave as a discrete system sees it.
struct Branch {
  std::complex<double> eigenvalue;            ///< of S, 1 over time squared
  std::optional<std::complex<double>> slope;  ///< its derivative in |xi|; none at a defective S
  double exact;                               ///< omega of the differential equations
};

/// Names of the branches, from the fastest: P, S; in 3D P, S1, S2.
std::vector<std::string> branch_names(int fields);

/// The waves of one wave vector, in the order of `branch_names`: each eigenvector of S belongs to
/// the exact wave whose polarisation it shares most; of waves as fast as each other, the one that S
/// makes faster comes first. Empty where S does not exist. `direction` is the unit vector along xi.
template <int Dim>
std::vector<Branch> branches(const NodeSymbol<Dim>& symbol, const ExactSymbol<Dim>& exact,
                             const Point<Dim>& xi, const Point<Dim>& direction);

/// The eigenvalues of S at a wave vector, in no order; parts of them that are round-off are 0.
/// Empty where S does not exist.
template <int Dim>
std::vector<std::complex<double>> eigenvalues(const NodeSymbol<Dim>& symbol, const Point<Dim>& xi);

/// A circular frequency, 1 over time: a positive imaginary part damps the wave, a negative one
/// makes it grow.
struct Frequency {
  std::complex<double> omega;
  std::optional<std::complex<double>> per_eigenvalue;  ///< d omega / d lambda, none where infinite
};

/// The frequency of u'' = lambda u with a real part of at least 0, of two such roots the one that
/// grows: exact in time, or under central differences of step `dt`, omega = acos(1 + dt^2 lambda /
/// 2) / dt, computed as 2 asin(dt sqrt(-lambda) / 2) / dt, which keeps its digits for small steps.
/// Source: thesis (4.38).
Frequency frequency(std::complex<double> eigenvalue, std::optional<double> dt);

}  // namespace strongpoint
