#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "studies/support/row.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {

/// The axes of a case grid as a user wrote them: lists of specs, or `all`.
struct AxisTexts {
  std::string problem, method, cloud, form, solver, levels;
  std::string mesh_cloud;              ///< of problems that have a mesh of their own
  std::optional<std::string> stencil;  ///< without it every method is run with its own default
  std::optional<std::uint64_t> seed;   ///< joins the spec of clouds that know a seed and give none
};

/// A case to be run, or one of which it is known beforehand that it will not be.
struct PlannedCase {
  CaseKey key;  ///< level 0 for a cloud read from a file, until its nodes have been counted
  int dimension = 0;
  std::vector<std::string> quantities;  ///< expected ones; `all` when they cannot be told
  Status status = Status::ok;           ///< other than ok: not run, for `reason`
  std::string reason;
};

/// Text that is the same for a planned case and its rows, and for no other case: the level of a
/// cloud read from a file is known only afterwards and does not count.
std::string identity_of(const CaseKey& key);

/// The level of a cloud of `nodes` nodes that is not made to a level: round(nodes^(1/dimension)).
int level_of(std::int64_t nodes, int dimension);

/// The case grid in canonical specs, in table order: problem, method, stencil, cloud, form, solver,
/// level. A case written twice is planned once. Throws UsageError, naming the option, for anything
/// that is malformed, unknown or out of range.
std::vector<PlannedCase> plan_cases(const AxisTexts& texts, const Study& study,
                                    const Options& extra);

}  // namespace strongpoint
