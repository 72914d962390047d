#include "studies/support/spectrum_case.hpp"
#include "studies/support/study.hpp"

/// Spectra of problems of waves: how fast their operators vibrate and grow, the steps they allow,
/// and how true their modes are.
int main(int argc, char** argv) {
  using namespace strongpoint;  // NOLINT(google-build-using-namespace)
  Study study;
  study.name = "eigenvalues";
  study.summary = "eigenvalues, growth and stable steps of waves, and their modes";
  study.defaults.problem = "bar_1d";
  study.defaults.method = "mfpm";
  study.defaults.levels = "101";
  study.timed = true;
  study.rated = false;
  study.mapped = true;
  study.extra_options = spectrum_option_docs();
  study.extra_columns = spectrum_columns();
  study.check_options = [](const Options& extra) { spectrum_options(extra); };
  study.keeps = [](const CaseKey&, const std::vector<std::string>& columns, const Options& extra) {
    return same_options(columns, spectrum_options(extra));
  };
  study.quantities = [](const CaseKey& key, const Options& extra) {
    return spectrum_quantities(key, spectrum_options(extra));
  };
  study.run = [](const CaseKey& key, const RunOptions& options, const Options& extra) {
    return run_spectrum_case(key, options, spectrum_options(extra));
  };
  return run_study(argc, argv, study);
}
