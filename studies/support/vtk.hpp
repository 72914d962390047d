#pragma once

#include <string>
#include <vector>

#include "methods/core/sites.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {

/// A number at every node, under a name; NaN where there is none.
struct NodeArray {
  std::string name;
  std::vector<double> values;  ///< (N)
};

/// The zones of nodes as the array "zone", 1 at the boundary.
NodeArray zone_array(const std::vector<Zone>& zones);

/// Nodes with numbers as an unstructured grid of VTK's XML format (.vtu), one vertex cell a node,
/// which ParaView opens; `title` is kept in it as the field data "case". Numbers are stored in
/// base64, so that they come back to the bit and NaN may be among them. Source: VTK file formats,
/// "XML file formats". Throws std::invalid_argument when an array does not hold a number per node.
template <int Dim>
std::string vtu_text(const Points<Dim>& nodes, const std::vector<NodeArray>& arrays,
                     const std::string& title);

/// The file of a case in a directory: study, problem, method, stencil, cloud and level in safe
/// characters, and a hash that tells apart what those leave equal.
std::string vtu_path(const VtkOutput& output, const CaseKey& key);

/// Writes the file of a case. Throws WriteError.
template <int Dim>
void write_vtu(const VtkOutput& output, const CaseKey& key, const Points<Dim>& nodes,
               const std::vector<NodeArray>& arrays);

}  // namespace strongpoint
