#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "methods/core/sites.hpp"
#include "problems/core/node_array.hpp"
#include "problems/core/point_cloud.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {

/// One number a node as an array.
NodeArray scalar_array(const std::string& name, std::span<const double> values);

/// The zones of nodes as the array "zone", 1 at the boundary.
NodeArray zone_array(const std::vector<Zone>& zones);

/// Nodes with numbers as an unstructured grid of VTK's XML format (.vtu), one vertex cell a node,
/// which ParaView opens; `title` is kept in it as the field data "case", and a time as
/// "TimeValue", where ParaView looks for it. Numbers come back to the bit and NaN may be among
/// them. Source: written by VTK's vtkXMLUnstructuredGridWriter. Throws
/// std::invalid_argument when an array does not hold a column per node.
template <int Dim>
std::string vtu_text(const Points<Dim>& nodes, const std::vector<NodeArray>& arrays,
                     const std::string& title, std::optional<double> time = {});

/// The nodes of a cloud likewise, in the order of their numbers.
template <int Dim>
std::string cloud_text(const PointCloud<Dim>& cloud, std::vector<NodeArray> arrays,
                       const std::string& title, std::optional<double> time = {});

/// A case in words, for people.
std::string title_of(const CaseKey& key);

/// A case as a part of file names: problem, method, stencil, cloud and level in safe characters,
/// and a hash that tells apart what those leave equal; `rest` is what else tells two runs of a case
/// apart.
std::string file_stem(const CaseKey& key, const std::string& rest = {});

/// The file of a case in a directory: study and `file_stem`.
std::string vtu_path(const VtkOutput& output, const CaseKey& key, const std::string& rest = {});

/// Writes the file of a case, nodes in the order of their numbers. Throws WriteError.
template <int Dim>
void write_vtu(const VtkOutput& output, const CaseKey& key, const PointCloud<Dim>& cloud,
               const std::vector<NodeArray>& arrays);

}  // namespace strongpoint
