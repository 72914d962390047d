#pragma once

#include "problems/core/layout.hpp"
#include "problems/core/structured.hpp"

namespace strongpoint {

/// Documents the option `stretch` of a structured layout.
inline OptionDoc stretch_option() {
  return {"stretch", "1",
          "cells longer along the first axis by this factor, with as many in all, 0.01 to 100"};
}

/// The equidistant lattice of a request, stretched as its options say.
template <int Dim>
UnitLattice<Dim> stretched_lattice(const Domain<Dim>& domain, const Options& options,
                                   const LayoutRequest& request) {
  const double stretch = options.number("stretch", 0.01, 100);
  return graded_lattice<Dim>(stretched_counts(domain, request.level, stretch), 1);
}

}  // namespace strongpoint
