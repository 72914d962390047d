#include "studies/support/run_case.hpp"
#include "studies/support/study.hpp"

/// Errors of steady problems under refinement, with their observed orders and the time of each
/// stage.
int main(int argc, char** argv) {
  using namespace strongpoint;  // NOLINT(google-build-using-namespace)
  Study study;
  study.name = "convergence";
  study.summary = "errors of steady problems under refinement";
  study.defaults.problem = "plate_hole";
  study.defaults.method = "zoned";
  study.timed = true;
  study.mapped = true;
  study.quantities = [](const CaseKey& key, const Options&) { return steady_quantities(key); };
  study.run = [](const CaseKey& key, const RunOptions& options, const Options&) {
    return run_steady_case(key, options);
  };
  return run_study(argc, argv, study);
}
