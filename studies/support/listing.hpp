#pragma once

#include <string>

#include "studies/support/study.hpp"

namespace strongpoint {

/// Describes all that the axes of a study can be chosen from: problems, methods, stencil rules,
/// clouds, forms, solvers, weights and search engines, with their options and defaults.
std::string listing(const Study& study);

}  // namespace strongpoint
