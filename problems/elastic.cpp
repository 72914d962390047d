#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "methods/core/error.hpp"
#include "problems/core/elastic_conditions.hpp"
#include "problems/core/elastic_fields.hpp"
#include "problems/core/elastic_problem.hpp"
#include "problems/core/mesh_file.hpp"

namespace strongpoint {
namespace {

template <int Dim>
class Elastic final : public ElasticProblem<Dim> {
 public:
  Elastic(ElasticCase elastic, const Mesh& mesh, Unknowns unknowns)
      : ElasticProblem<Dim>(unknowns),
        case_(std::move(elastic)),
        domain_(mesh, case_.mesh),
        conditions_(conditions_of(case_, domain_)),
        material_(material_of(case_)) {
    if (this->is_mixed() && material_.lambda == 0) {
      throw UsageError("unknowns=mixed needs a Poisson's ratio other than 0; leave it out");
    }
  }

  const Domain<Dim>& domain() const override { return domain_; }
  Lame material(const Place<Dim>&) const override { return material_; }
  Point<Dim> body_force(const Place<Dim>&) const override { return conditions_.force; }
  std::vector<SymmetryPlane> symmetry_planes() const override {
    return conditions_.symmetry_planes;
  }
  Derivatives<Dim> measured_derivatives() const override { return this->first_derivatives(); }

  Known known(int field, int side) const override {
    return given_displacement(field, side) ? Known::value : Known::flux;
  }
  double given(int field, int side, const Point<Dim>& x) const override {
    if (field >= Dim) return 0;
    if (const std::optional<double> value = given_displacement(field, side)) return *value;
    const SideCondition<Dim>& load = conditions_.sides[side];
    if (load.pressure == 0) return load.traction[field];
    return load.traction[field] - load.pressure * domain_.normal(side, x)[field];
  }

  std::vector<std::string> quantities() const override {
    std::vector<std::string> names{"max_displacement", "max_von_mises"};
    for (const ProbeSpec& probe : case_.probes) {
      for (int i = 0; i < Dim; ++i) names.push_back(fmt::format("u{}_{}", "xyz"[i], probe.name));
      names.push_back("von_mises_" + probe.name);
    }
    return names;
  }

  /// Displacements of probes are continued from the nearest node by its gradient; von Mises
  /// stresses are those of that node.
  std::vector<double> measure(const Solution<Dim>& solution) const override {
    const Points<Dim> displacement = solution.fields.topRows(Dim);
    const Eigen::MatrixXd stresses = this->nodal_stresses(solution);
    Eigen::VectorXd equivalent(solution.cloud.size());
    for (int n = 0; n < solution.cloud.size(); ++n) {
      equivalent[n] = von_mises<Dim>(stresses.col(n), across());
    }
    std::array<Eigen::VectorXd, Dim * Dim> slopes;
    for (int d = 0; d < Dim * Dim; ++d) {
      slopes[d] = solution.derivative(d / Dim, partial<Dim>(d % Dim));
    }
    std::vector<double> values{displacement.colwise().norm().maxCoeff(), equivalent.maxCoeff()};
    for (const Point<Dim>& place : conditions_.probes) {
      Eigen::Index node = 0;
      (solution.cloud.nodes.colwise() - place).colwise().squaredNorm().minCoeff(&node);
      const Point<Dim> step = place - solution.cloud.nodes.col(node);
      for (int i = 0; i < Dim; ++i) {
        double value = displacement(i, node);
        for (int j = 0; j < Dim; ++j) value += step[j] * slopes[i * Dim + j][node];
        values.push_back(value);
      }
      values.push_back(equivalent[node]);
    }
    return values;
  }

  std::vector<NodeArray> derived_fields(const Solution<Dim>& solution) const override {
    const std::vector<Lame> materials(static_cast<std::size_t>(solution.cloud.size()), across());
    return elastic_arrays<Dim>(this->fields(), materials,
                               {solution.fields, this->nodal_stresses(solution)}, std::nullopt);
  }

 private:
  ElasticCase case_;
  MeshDomain<Dim> domain_;
  ElasticConditions<Dim> conditions_;
  Lame material_;

  std::optional<double> given_displacement(int field, int side) const {
    if (field >= Dim) return std::nullopt;
    return conditions_.sides[side].displacement[field];
  }

  /// The material by which von Mises' stress knows the stress across the plane: with lambda = 0
  /// there is none, as in plane stress.
  Lame across() const {
    return case_.state == PlaneState::stress ? Lame{0, material_.mu} : material_;
  }
};

/// The problem of a case file and its mesh.
AnyProblem read_problem(const std::string& path, Unknowns unknowns) {
  ElasticCase elastic = read_elastic_case(path);
  const Mesh mesh = load_mesh(elastic.mesh);
  if (mesh.dimension == 2) return std::make_unique<Elastic<2>>(std::move(elastic), mesh, unknowns);
  if (mesh.dimension == 3) return std::make_unique<Elastic<3>>(std::move(elastic), mesh, unknowns);
  throw CaseError(fmt::format("{}: has no elements of dimension 2 or 3; mesh it with gmsh -2 or -3",
                              elastic.mesh));
}

/// What is wrong with the files is wrong with the spec: it is told before anything runs.
AnyProblem make_elastic(const Options& options) {
  if (!options.has("case")) {
    throw UsageError(
        "elastic: case= is missing; give the case file, as in elastic[case=bracket.toml]");
  }
  try {
    return read_problem(options.text("case"), chosen_unknowns(options));
  } catch (const CaseError& error) {
    throw UsageError(error.what());
  }
}

}  // namespace

/// Static elasticity of a body meshed with Gmsh, in 2D or 3D by its mesh, with material, supports
/// and loads from a case file. Source: thesis (4.1) to (4.4); plane stress by lambda* = 2 lambda mu
/// / (lambda + 2 mu), Timoshenko & Goodier 1970.
ProblemEntry problem_elastic() {
  return {{"elastic",
           "static elasticity on a Gmsh mesh, with supports and loads from a case file",
           {{"case", "", "the case file (TOML): mesh, [material], [support.GROUP], [load.GROUP]"},
            unknowns_option()}},
          make_elastic};
}

}  // namespace strongpoint
