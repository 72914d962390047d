#include "studies/support/study.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <new>

#include <fmt/format.h>
#include <omp.h>

#include "studies/support/case_monitor.hpp"
#include "studies/support/cloud_spec.hpp"
#include "studies/support/command_line.hpp"
#include "studies/support/csv.hpp"
#include "studies/support/interruption.hpp"
#include "studies/support/listing.hpp"
#include "studies/support/output.hpp"
#include "studies/support/progress.hpp"
#include "studies/support/provenance.hpp"
#include "studies/support/readable_table.hpp"
#include "studies/support/resume.hpp"
#include "studies/support/row.hpp"
#include "studies/support/table_file.hpp"

namespace strongpoint {
namespace {

enum ExitStatus { all_good = 0, something_failed = 1, bad_arguments = 2 };

/// One run of a case grid, from the plan to the tables.
class GridRun {
 public:
  GridRun(const Study& study, const CommandLine& line, Provenance provenance)
      : study_(study),
        line_(line),
        provenance_(std::move(provenance)),
        table_(study.name, line.csv) {}

  ExitStatus execute();

 private:
  const Study& study_;
  const CommandLine& line_;
  Provenance provenance_;
  TableFile table_;
  std::vector<PlannedCase> plan_;
  CaseMonitor monitor_;
  std::mutex mutex_;  ///< guards what follows against the watcher of signals
  bool started_ = false;
  std::vector<std::vector<Row>> cases_;
  bool json_failed_ = false;

  void start();
  void keep_rows_left_out(int count) const;
  void run_cases();
  bool waits_for_the_end() const { return study_.conclude && is_stream(line_.csv); }
  std::vector<Row> run_case(const PlannedCase& planned);
  void finish();
  void write_json();
  void interrupted();
  std::string text_of(const std::vector<Row>& rows) const;
  std::string header() const;
};

std::string GridRun::header() const {
  std::vector<std::string> names;
  for (const Column& column : columns_of(study_)) names.push_back(column.name);
  return csv_line(names);
}

std::string GridRun::text_of(const std::vector<Row>& rows) const {
  std::string text;
  for (const Row& row : rows) text += csv_line(fields_of(row, study_));
  return text;
}

/// A table resumed into its own file may hold rows that the new one has no place for.
void GridRun::keep_rows_left_out(int count) const {
  std::error_code error;
  if (count == 0 || !std::filesystem::equivalent(line_.resume, line_.csv, error)) return;
  std::string copy = line_.csv + ".old";
  for (int i = 2; std::filesystem::exists(copy, error); ++i) {  // earlier copies hold other rows
    copy = fmt::format("{}.old{}", line_.csv, i);
  }
  std::filesystem::copy_file(line_.csv, copy, error);
  if (error) {
    throw UsageError(
        fmt::format("--resume {}: holds {} rows of other cases, options or another code version, "
                    "which cannot be saved as {} ({}); name another --csv",
                    line_.resume, count, copy, error.message()));
  }
  tell(fmt::format("{}: {} rows of other cases, options or another code version are kept in {}",
                   study_.name, count, copy));
}

void GridRun::start() {
  for (const auto& [option, path] : {std::pair{"--csv", line_.csv}, {"--json", line_.json}}) {
    if (!path.empty()) check_writable(option, path);
  }
  if (line_.run.vtk) make_directory("--vtk", line_.run.vtk->directory);
  Resumed resumed;
  resumed.cases.resize(plan_.size());
  if (!line_.resume.empty()) {
    resumed =
        read_resumed(line_.resume, plan_, study_, line_.run.threads, code_version(), line_.extra);
    keep_rows_left_out(resumed.left_out);
  }
  const std::lock_guard lock(mutex_);
  cases_ = std::move(resumed.cases);
  std::string text = header();
  // A stream cannot be put in order afterwards, so there kept rows wait for their turn.
  if (!is_stream(line_.csv)) {
    for (const std::vector<Row>& rows : cases_) text += text_of(rows);
  }
  table_.start(text);
  started_ = true;
}

std::vector<Row> GridRun::run_case(const PlannedCase& planned) {
  RowFrame frame{study_, planned.key, line_.run.threads, code_version()};
  const auto without_value = [&](Status status, std::string_view reason) {
    return rows_without_value(frame, planned.quantities, status, reason);
  };
  if (planned.status != Status::ok) return without_value(planned.status, planned.reason);
  try {
    RunOptions options = line_.run;
    options.monitor = &monitor_;
    const CaseResult result = study_.run(planned.key, options, line_.extra);
    if (is_file_cloud(planned.key.cloud)) {
      frame.key.level = level_of(result.nodes, planned.dimension);
    }
    return rows_of_result(frame, planned.quantities, result);
  } catch (const SkipCase& error) {
    return without_value(Status::skipped, error.what());
  } catch (const UsageError&) {
    throw;
  } catch (const std::bad_alloc&) {
    return without_value(Status::failed, "out of memory; choose a lower level");
  } catch (const std::exception& error) {
    return without_value(Status::failed, error.what());
  } catch (...) {
    return without_value(Status::failed, "an error that names no cause");
  }
}

void GridRun::run_cases() {
  std::vector<CaseKey> pending;
  for (std::size_t i = 0; i < plan_.size(); ++i) {
    if (cases_[i].empty()) pending.push_back(plan_[i].key);
  }
  Progress progress(pending);
  monitor_.show = [&](std::int64_t done, std::int64_t steps) { progress.steps(done, steps); };
  monitor_.note = [&](const std::string& line) {
    progress.clear();
    tell(fmt::format("{}: {}", study_.name, one_line(line)));
  };
  for (std::size_t i = 0; i < plan_.size(); ++i) {
    const bool kept = !cases_[i].empty();
    std::vector<Row> rows;
    if (!kept) {
      progress.starts(plan_[i].key);
      rows = run_case(plan_[i]);
      progress.ends(plan_[i].key);
    }
    const std::lock_guard lock(mutex_);
    if (!kept) cases_[i] = std::move(rows);
    if (study_.rated) fill_rates(cases_, i, study_.unrated);
    if (waits_for_the_end()) continue;
    if (!kept || is_stream(line_.csv)) table_.append(text_of(cases_[i]));
  }
}

void GridRun::write_json() {
  if (line_.json.empty()) return;
  if (study_.timed) add_calibration(provenance_);
  try {
    write_whole(line_.json, json_text(provenance_, cases_, study_));
  } catch (const WriteError& error) {
    tell(fmt::format("{}: {}", study_.name, error.what()));
    json_failed_ = true;
  }
}

/// Writes what takes the whole table: its order, the JSON document, the readable form. A JSON
/// document that could not be written leaves the rows to be seen at least.
void GridRun::finish() {
  if (study_.conclude) study_.conclude(cases_);
  std::string rows_text;
  for (const std::vector<Row>& rows : cases_) rows_text += text_of(rows);
  if (waits_for_the_end()) table_.append(rows_text);
  table_.finish(header() + rows_text);
  write_json();
  if (line_.prints_readable && (line_.json != "-" || json_failed_)) {
    append_to("-", readable_table(cases_, study_));
    if (study_.appendix) append_to("-", study_.appendix(cases_));
  }
}

/// Runs in the watcher of signals while a case is still being computed; the process ends after it.
void GridRun::interrupted() {
  constexpr std::chrono::seconds patience(10);  // a step takes less
  monitor_.save.ask(patience);
  mutex_.lock();  // never given back: no row may follow the tables
  try {
    if (started_) finish();
  } catch (const WriteError& error) {
    tell(fmt::format("{}: {}", study_.name, error.what()));
  }
  const auto done = std::count_if(cases_.begin(), cases_.end(),
                                  [](const std::vector<Row>& rows) { return !rows.empty(); });
  const std::string advice =
      line_.csv.empty() || line_.csv == "-" ? "" : "; continue with --resume " + line_.csv;
  tell(fmt::format("{}: interrupted after {} of {} cases{}", study_.name, done, cases_.size(),
                   advice));
}

ExitStatus GridRun::execute() {
  {
    const Interruption watch([this] { interrupted(); });
    plan_ = plan_cases(line_.axes, study_, line_.extra);
    start();
    try {
      run_cases();
    } catch (const UsageError&) {
      finish();
      throw;
    }
  }
  finish();
  const bool failed = std::any_of(cases_.begin(), cases_.end(), [](const std::vector<Row>& rows) {
    return std::any_of(rows.begin(), rows.end(),
                       [](const Row& row) { return row.status == Status::failed; });
  });
  return failed || table_.failed() || json_failed_ ? something_failed : all_good;
}

ExitStatus run(int argc, char** argv, const Study& study) {
  const CommandLine line = parse_command_line(argc, argv, study);
  switch (line.action) {
    case CommandLine::Action::list:
      append_to("-", listing(study));
      return all_good;
    case CommandLine::Action::print:
      append_to("-", line.text);
      return all_good;
    case CommandLine::Action::run:
      break;
  }
  if (study.prepare) study.prepare(line.extra, line.run);
  omp_set_num_threads(line.run.threads);
  return GridRun(study, line, provenance_of(study, argc, argv, line.run.threads)).execute();
}

}  // namespace

int run_study(int argc, char** argv, const Study& study) {
  const auto complain = [&](const char* what, ExitStatus status) {
    tell(fmt::format("{}: {}", study.name, one_line(what)));
    return status;
  };
  try {
    return run(argc, argv, study);
  } catch (const UsageError& error) {
    return complain(error.what(), bad_arguments);
  } catch (const std::exception& error) {
    return complain(error.what(), something_failed);
  }
}

}  // namespace strongpoint
