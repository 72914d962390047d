#include "studies/support/provenance.hpp"

#include <ctime>
#include <filesystem>
#include <fstream>
#include <ratio>
#include <thread>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <fmt/format.h>
#include <nanoflann.hpp>
#include <nlohmann/json.hpp>
#include <umfpack.h>

#include "methods/core/simd/path.hpp"
#include "studies/support/calibration.hpp"

namespace strongpoint {
namespace {

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string command_line(int argc, const char* const* argv) {
  std::string text = std::filesystem::path(argv[0]).filename().string();
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    // Brackets and the like mean something to a shell; quoted, the line can be pasted back.
    const bool plain = !argument.empty() &&
                       argument.find_first_of(" \t\n\"'\\$*?[](){}<>|&;#~`!") == std::string::npos;
    text += plain ? " " + argument : " '" + argument + "'";
  }
  return text;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

/// What StageClock measures.
std::string clock_name(int threads) {
  return threads > 1 ? "wall time (several threads)" : "process CPU time (one thread)";
}

std::string nanoflann_version() {
  return fmt::format("{}.{}.{}", NANOFLANN_VERSION >> 8, (NANOFLANN_VERSION >> 4) & 0xf,
                     NANOFLANN_VERSION & 0xf);
}

nlohmann::ordered_json json_of(const Row& row, const std::vector<Column>& columns,
                               const Study& study) {
  nlohmann::ordered_json object;
  const std::vector<std::string> fields = fields_of(row, study);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (columns[i].kind == Column::Kind::text) {
      object[columns[i].name] = fields[i];
    } else {
      // Shortest round-trip numbers are JSON as they stand.
      object[columns[i].name] =
          fields[i].empty() ? nlohmann::ordered_json() : nlohmann::ordered_json::parse(fields[i]);
    }
  }
  return object;
}

}  // namespace

Provenance provenance_of(const Study& study, int argc, const char* const* argv, int threads) {
  return {{"study", study.name},
          {"command_line", command_line(argc, argv)},
          {"code_version", code_version()},
          {"compiler", STRONGPOINT_COMPILER},
          {"compiler_flags", STRONGPOINT_COMPILER_FLAGS},
          {"build_type", STRONGPOINT_BUILD_TYPE},
          {"eigen",
           fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
                              FMT_VERSION % 100)},
          {"nanoflann", nanoflann_version()},
          {"umfpack", fmt::format("{}.{}.{}", UMFPACK_MAIN_VERSION, UMFPACK_SUB_VERSION,
                                  UMFPACK_SUBSUB_VERSION)},
          {"cli11", CLI11_VERSION},
          {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                        NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
          {"cpu", cpu_model()},
          {"simd", std::string(name_of(simd_path()))},
          {"cores", fmt::format("{}", std::thread::hardware_concurrency())},
          {"threads", fmt::format("{}", threads)},
          {"clock", clock_name(threads)},
          {"date", utc_now()}};
}

void add_calibration(Provenance& provenance) {
  const Calibration figures = calibrate();
  provenance.emplace_back("copy_gigabytes_per_second",
                          fmt::format("{:.1f}", figures.copy_gigabytes_per_second));
  provenance.emplace_back("umfpack_laplacian_100x100_seconds",
                          fmt::format("{:.4f}", figures.factor_seconds));
}

std::string json_text(const Provenance& provenance, const std::vector<std::vector<Row>>& cases,
                      const Study& study) {
  // A path may hold bytes that are not UTF-8; they must not cost the table.
  constexpr auto replace = nlohmann::ordered_json::error_handler_t::replace;
  nlohmann::ordered_json origin;
  for (const auto& [what, value] : provenance) origin[what] = value;
  std::string text = "{\n\"provenance\": " + origin.dump(2, ' ', false, replace) + ",\n\"rows\": [";
  const std::vector<Column> columns = columns_of(study);
  const char* separator = "\n";
  for (const std::vector<Row>& rows : cases) {
    for (const Row& row : rows) {
      text += separator + json_of(row, columns, study).dump(-1, ' ', false, replace);
      separator = ",\n";
    }
  }
  return text + "\n]\n}\n";
}

}  // namespace strongpoint
