#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace strongpoint {

/// One line of a CSV table, newline included; fields are quoted where RFC 4180 asks for it.
std::string csv_line(const std::vector<std::string>& fields);

/// The records of a CSV text.
struct CsvText {
  std::vector<std::vector<std::string>> records;
  std::string torn;  ///< what follows the last complete record, as it stands in the text
};

/// Splits a text by RFC 4180; lines may end with or without a carriage return. What comes after the
/// last line end is not a record: a writer that was killed left it.
CsvText parse_csv(std::string_view text);

}  // namespace strongpoint
