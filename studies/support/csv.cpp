#include "studies/support/csv.hpp"

namespace strongpoint {
namespace {

std::string quoted(const std::string& field) {
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string text = "\"";
  for (char c : field) {
    if (c == '"') text += '"';
    text += c;
  }
  return text + '"';
}

}  // namespace

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) line += ',';
    line += quoted(fields[i]);
  }
  return line + '\n';
}

CsvText parse_csv(std::string_view text) {
  CsvText result;
  std::vector<std::string> record;
  std::string field;
  bool quoting = false;
  std::size_t record_start = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      // A doubled quote inside quotes is a literal one; quoting then resumes at the second.
      if (!quoting && i > 0 && text[i - 1] == '"' && i > record_start) field += '"';
      quoting = !quoting;
    } else if (!quoting && c == ',') {
      record.push_back(std::move(field));
      field.clear();
    } else if (!quoting && c == '\n') {
      if (!field.empty() && field.back() == '\r') field.pop_back();
      record.push_back(std::move(field));
      field.clear();
      result.records.push_back(std::move(record));
      record.clear();
      record_start = i + 1;
    } else {
      field += c;
    }
  }
  result.torn = text.substr(record_start);
  return result;
}

}  // namespace strongpoint
