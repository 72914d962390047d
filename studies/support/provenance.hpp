#pragma once

#include <string>
#include <utility>
#include <vector>

#include "studies/support/row.hpp"

namespace strongpoint {

/// Version of the code in this program: `git describe`, with a hash of the sources when they differ
/// from what is committed; the hash alone without a repository. Defined in a file the build writes.
const std::string& code_version();

/// Where a table comes from, as (what, value) pairs.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// Tells study, command line, code, compiler, libraries, machine, clock and the date of the call.
/// The program's directory is left out of the command line; everything else is as the user typed
/// it.
Provenance provenance_of(const Study& study, int argc, const char* const* argv, int threads);

/// Adds what the machine does just now with two well-known pieces of work, for tables of times.
void add_calibration(Provenance& provenance);

/// The table as a JSON document: an object with `provenance`, an object, and `rows`, a list of
/// objects with one member per column, numbers as numbers and empty ones as null.
std::string json_text(const Provenance& provenance, const std::vector<std::vector<Row>>& cases,
                      const Study& study);

}  // namespace strongpoint
