#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "problems/core/elasticity.hpp"

namespace strongpoint {

/// What a plane problem assumes of the third direction.
enum class PlaneState {
  strain,  ///< no strain along it
  stress   ///< no stress along it
};

/// Displacements given on a physical group.
struct SupportSpec {
  std::string group;
  int line;                                           ///< in the case file
  std::array<std::optional<double>, 3> displacement;  ///< along x, y, z; free where not given
  bool is_symmetry = false;                           ///< instead: no displacement along the normal
};

/// What acts on a physical group: a traction, or a pressure against its outward normal.
struct LoadSpec {
  std::string group;
  int line;
  std::vector<double> traction;  ///< force over area, one component an axis; empty with a pressure
  double pressure = 0;
};

/// A named place where results are printed.
struct ProbeSpec {
  std::string name;
  int line;
  std::vector<double> place;
};

/// A static case of linear elasticity in any consistent set of units.
struct ElasticCase {
  std::string path;  ///< of the case file
  std::string mesh;  ///< path of the mesh, found from where the case file is
  double young = 0;
  double poisson = 0;
  PlaneState state = PlaneState::strain;
  int state_line = 0;  ///< 0 when the file gives no state
  std::vector<SupportSpec> supports;
  std::vector<LoadSpec> loads;
  std::vector<double> force;  ///< force over volume, one component an axis; empty for none
  int force_line = 0;
  std::vector<ProbeSpec> probes;  ///< in the order of the file
};

/// Reads a case file: TOML with `mesh`, [material] young, poisson and state ("plane_strain", which
/// is the default, or "plane_stress"), [support.GROUP] ux, uy, uz or symmetry = true, [load.GROUP]
/// traction or pressure, [body] force and [probe] name = place. Throws CaseError, beginning with
/// the path and, where there is one, the line, for a file that cannot be read or is no TOML, an
/// unknown key, a missing or wrong value, and a group with two conditions.
ElasticCase read_elastic_case(const std::string& path);

/// Throws the CaseError of a line of a case file; without the line when it is 0.
[[noreturn]] void fail_in_case(const ElasticCase& elastic, int line, const std::string& what);

/// Lame constants that a case's plane or solid body moves by: plane stress is plane strain with
/// lambda* = 2 lambda mu / (lambda + 2 mu).
Lame material_of(const ElasticCase& elastic);

}  // namespace strongpoint
