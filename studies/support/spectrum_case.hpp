#pragma once

#include <optional>
#include <string>
#include <vector>

#include "methods/core/options.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {

/// Unknowns up to which all eigenvalues are computed unless a user says otherwise.
constexpr int dense_limit = 2500;

/// How the eigenvalues of a case are found and which of its modes are judged.
struct SpectrumOptions {
  enum class Engine {
    automatic,  ///< dense up to `dense_limit` unknowns
    dense,      ///< all eigenvalues
    spectra     ///< a few, from products and one factorisation
  };
  Engine engine = Engine::automatic;
  std::string modes;           ///< canonical text of `shares`
  std::vector<double> shares;  ///< of the number of modes, above 0 to 1; empty: every mode
  std::string time;            ///< canonical spec of the integrator
  std::string damping;         ///< canonical spec
};

/// The options of the study.
std::vector<OptionDoc> spectrum_option_docs();

/// Reads them. Throws UsageError for values that do not fit.
SpectrumOptions spectrum_options(const Options& extra);

/// Names of the columns that tell how a number was found, and of which mode it speaks.
std::vector<std::string> spectrum_columns();

/// Whether the columns of a row are those of these options.
bool same_options(const std::vector<std::string>& columns, const SpectrumOptions& options);

/// Names of what a case gives. Throws SkipCase when the problem is of another kind.
std::vector<std::string> spectrum_quantities(const CaseKey& key, const SpectrumOptions& options);

/// The spectrum of a problem of waves: `spectral_radius`, `largest_real` and `largest_imaginary`
/// part of the operator's eigenvalues, `growth_rate` (1 over time), `stable_step` of the integrator
/// and `step_growth_rate` at its step (1 over time, damping included), `non_normality` (condition
/// of the eigenvectors), `residual` (largest of the eigenpairs); where the modes are known,
/// `frequency_ratio`, `frequency_imaginary` (1 over time) and `mode_error` (relative 2-norm over
/// all nodes) of the modes chosen. With `options.vtk` these modes are written, elsewhere the four
/// lowest and the fastest growing one. Throws SkipCase and CaseError.
CaseResult run_spectrum_case(const CaseKey& key, const RunOptions& options,
                             const SpectrumOptions& spectrum);

}  // namespace strongpoint
