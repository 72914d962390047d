#include "problems/core/transient_problem.hpp"
#include "studies/support/run_case.hpp"
#include "studies/support/study.hpp"
#include "studies/support/transient_case.hpp"

/// Errors of problems under refinement, with their observed orders and the time of each stage;
/// steady problems and problems in time.
int main(int argc, char** argv) {
  using namespace strongpoint;  // NOLINT(google-build-using-namespace)
  Study study;
  study.name = "convergence";
  study.summary = "errors of problems, steady or in time, under refinement";
  study.defaults.problem = "plate_hole";
  study.defaults.method = "zoned";
  study.timed = true;
  study.mapped = true;
  study.extra_options = time_option_docs();
  study.extra_columns = time_columns();
  study.check_options = [](const Options& extra) { time_options(extra); };
  study.prepare = prepare_time;
  study.keeps = keeps_time;
  study.unrated = unrated_quantities();
  study.quantities = [](const CaseKey& key, const Options&) {
    return is_kind<TransientProblem>(key.problem) ? transient_quantities(key)
                                                  : steady_quantities(key);
  };
  study.run = [](const CaseKey& key, const RunOptions& options, const Options& extra) {
    return is_kind<TransientProblem>(key.problem)
               ? run_transient_case(key, options, time_options(extra))
               : run_steady_case(key, options);
  };
  return run_study(argc, argv, study);
}
