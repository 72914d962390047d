#pragma once

#include <span>
#include <string>
#include <vector>

#include "methods/core/sites.hpp"
#include "problems/core/node_array.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {

/// One number a node as an array.
NodeArray scalar_array(const std::string& name, std::span<const double> values);

/// The zones of nodes as the array "zone", 1 at the boundary.
NodeArray zone_array(const std::vector<Zone>& zones);

/// Nodes with numbers as an unstructured grid of VTK's XML format (.vtu), one vertex cell a node,
/// which ParaView opens; `title` is kept in it as the field data "case". Numbers come back to the
/// bit and NaN may be among them. Source: written by VTK's vtkXMLUnstructuredGridWriter. Throws
/// std::invalid_argument when an array does not hold a column per node.
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
