#include <cmath>

#include "problems/core/domains/bored_block.hpp"
#include "problems/core/elastic_problem.hpp"
#include "problems/core/probes.hpp"

namespace strongpoint {
namespace {

using Point3 = Point<3>;
using Region = BoredBlock;

/// A stress component where the bore meets an axis, or u at the loaded end of the x axis.
struct Probe {
  const char* name;
  Point3 x;
  int stress;        ///< position in `stress_names`, -1 for u
  double reference;  ///< at nu = 0.3: p-version finite elements, p = 6 and 7 agree
};

const std::vector<Probe>& probes() {
  static const std::vector<Probe> all{{"stress_xx_y", {0, Region::radius, 0}, 0, 335.96},
                                      {"u_end", {Region::length, 0, 0}, -1, 0.70307},
                                      {"stress_xx_z", {0, 0, Region::radius}, 0, 294.53},
                                      {"stress_zz_x", {Region::radius, 0, 0}, 2, -94.88},
                                      {"stress_yy_x", {Region::radius, 0, 0}, 1, -80.40}};
  return all;
}

class BlockBore final : public ElasticProblem<3> {
 public:
  explicit BlockBore(double nu)
      : material_(lame_constants(young, nu)), has_references_(std::abs(nu - 0.3) < 1e-12) {}

  const Domain<3>& domain() const override { return domain_; }
  Lame material(const Place<3>&) const override { return material_; }
  std::vector<SymmetryPlane> symmetry_planes() const override {
    return {{Region::x0, 0, 0}, {Region::y0, 1, 0}, {Region::z0, 2, 0}};
  }
  Derivatives<3> measured_derivatives() const override { return first_derivatives(); }
  Known known(int field, int side) const override {
    return side == Region::x0 + field ? Known::value : Known::flux;
  }
  double given(int field, int side, const Point3&) const override {
    return side == Region::right && field == 0 ? tension : 0;
  }

  std::vector<std::string> quantities() const override {
    std::vector<std::string> names;
    for (const Probe& probe : probes()) names.emplace_back(probe.name);
    if (!has_references_) return names;
    for (const Probe& probe : probes()) names.push_back(std::string(probe.name) + "_error");
    return names;
  }
  std::vector<double> measure(const Solution<3>& solution) const override {
    const Eigen::MatrixXd stresses = nodal_stresses(solution);
    std::vector<double> values, errors;
    for (const Probe& probe : probes()) {
      const int node = node_at<3>(solution.cloud, probe.x);
      values.push_back(probe.stress < 0 ? solution.fields(0, node) : stresses(probe.stress, node));
      errors.push_back(std::abs(values.back() / probe.reference - 1));
    }
    if (has_references_) values.insert(values.end(), errors.begin(), errors.end());
    return values;
  }

 private:
  static constexpr double young = 1000;
  static constexpr double tension = 100;
  BoredBlock domain_;
  Lame material_;
  bool has_references_;
};

}  // namespace

/// One eighth of a block with a spherical bore under tension along x, E = 1000, free but for the
/// loaded face and the planes of symmetry. `stress_ij_k` is a stress where the bore meets axis k,
/// `u_end` the displacement along x at the loaded end of the x axis; their relative errors are
/// given for nu = 0.3, where converged values are known. Source: thesis 4.2.4.
ProblemEntry problem_block_bore() {
  return {{"block_bore",
           "eighth of a block with a spherical bore under tension, 3D",
           {{"nu", "0.3", "Poisson's ratio, 0 to 0.4999"}}},
          [](const Options& options) -> AnyProblem {
            return std::make_unique<BlockBore>(options.number("nu", 0, 0.4999));
          }};
}

}  // namespace strongpoint
