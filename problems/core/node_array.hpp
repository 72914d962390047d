#pragma once

#include <string>

#include <Eigen/Core>

namespace strongpoint {

/// Numbers at every node under a name, for looking at; NaN where there are none.
struct NodeArray {
  std::string name;        ///< letters, digits and underscores
  Eigen::MatrixXd values;  ///< (components, N)
};

/// |computed - exact|, component by component and in the units of the field, as `name` followed by
/// `_error`; both (components, N).
template <class A, class B>
NodeArray error_array(const std::string& name, const Eigen::MatrixBase<A>& computed,
                      const Eigen::MatrixBase<B>& exact) {
  return {name + "_error", (computed - exact).cwiseAbs()};
}

}  // namespace strongpoint
