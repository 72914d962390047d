#include "methods/core/error.hpp"
#include "problems/core/problem.hpp"

namespace strongpoint {

#define PROBLEM(name) ProblemEntry problem_##name();
#include "problems/problems.def"
#undef PROBLEM

const std::vector<ProblemEntry>& problems() {
  static const std::vector<ProblemEntry> entries = {
#define PROBLEM(name) problem_##name(),
#include "problems/problems.def"
#undef PROBLEM
  };
  return entries;
}

NamedProblem make_problem(std::string_view text) {
  const Spec spec = parse_spec(text);
  const ProblemEntry& entry = find_entry(problems(), "problem", spec.name);
  const Options options(entry.info, spec);
  return {options.canonical(), entry.make(options)};
}

template <int Dim>
Eigen::VectorXd Solution<Dim>::derivative(int field, const MultiIndex<Dim>& alpha) const {
  const int slot = derivatives.index(alpha);
  Eigen::VectorXd result(cloud.size());
  for (int p = 0; p < cloud.size(); ++p) {
    const std::span<const int> nodes = weights.nodes(p);
    if (nodes.empty()) {
      throw CaseError(fmt::format("{} at node {} {} is asked for, but the node has no stencil",
                                  name_of<Dim>(alpha), cloud.number_of(p),
                                  format_point(cloud.nodes.col(p))));
    }
    const Eigen::Map<const Eigen::MatrixXd> row = weights.row(p);
    double sum = 0;
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      sum += row(slot, static_cast<Eigen::Index>(j)) * parameters(field, nodes[j]);
    }
    result[p] = sum;
  }
  return result;
}

template struct Solution<1>;
template struct Solution<2>;
template struct Solution<3>;

}  // namespace strongpoint
