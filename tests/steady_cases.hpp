#pragma once

#include <string>
#include <vector>

#include "studies/support/run_case.hpp"

namespace strongpoint {

/// A case in two dimensions with the method's own stencils, collocation and umfpack.
inline CaseKey steady_case(const std::string& problem, const std::string& method,
                           const std::string& cloud, int level) {
  return {problem,   method, make_method<2>(method).made->default_stencil(), cloud, "collocation",
          "umfpack", level};
}

/// The quantities of a case, in the problem's order.
inline std::vector<double> errors_of(const CaseKey& key) {
  std::vector<double> values;
  for (const auto& quantity : run_steady_case(key, RunOptions{}).quantities) {
    values.push_back(quantity.value.value());
  }
  return values;
}

}  // namespace strongpoint
