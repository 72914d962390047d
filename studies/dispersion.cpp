#include "studies/support/dispersion.hpp"

/// Speeds, dissipation and growth of waves that the interior stencils of methods make, by the
/// symbol of the stencil in the middle of the domain.
int main(int argc, char** argv) {
  using namespace strongpoint;  // NOLINT(google-build-using-namespace)
  Study study;
  study.name = "dispersion";
  study.summary = "speeds, dissipation and growth of waves by the symbol of interior stencils";
  study.defaults.problem = "bar_1d";
  study.defaults.method = "mfpm,gfdm,lsfdm,rbf_fd";
  study.defaults.levels = "101";
  study.rated = false;
  study.extra_columns = dispersion_columns();
  study.variant_columns = {"branch", "direction", "wave"};
  study.extra_options = dispersion_option_docs();
  study.check_options = [](const Options& extra) { dispersion_options(extra); };
  study.quantities = [](const CaseKey& key, const Options& extra) {
    return dispersion_quantities(key, dispersion_options(extra));
  };
  study.keeps = [](const CaseKey&, const std::vector<std::string>& columns, const Options& extra) {
    return keeps_dispersion_row(columns, dispersion_options(extra));
  };
  study.run = [](const CaseKey& key, const RunOptions& options, const Options& extra) {
    return run_dispersion_case(key, options, dispersion_options(extra));
  };
  return run_study(argc, argv, study);
}
