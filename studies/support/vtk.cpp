#include "studies/support/vtk.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <fmt/format.h>

#include "studies/support/output.hpp"

namespace strongpoint {
namespace {

/// Longest part of a file name that one spec may take; nested rules are longer.
constexpr std::size_t longest_part = 60;

/// Numbers with a column per node as VTK keeps them.
vtkNew<vtkDoubleArray> vtk_array(const std::string& name, const Eigen::MatrixXd& values) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(static_cast<int>(values.rows()));
  array->SetNumberOfTuples(values.cols());
  std::copy_n(values.data(), values.size(), array->GetPointer(0));
  return array;
}

/// The nodes, each with a vertex cell.
template <int Dim>
void set_nodes(vtkUnstructuredGrid& grid, const Points<Dim>& nodes) {
  Eigen::MatrixXd positions = Eigen::MatrixXd::Zero(3, nodes.cols());  // no coordinate may lack
  positions.topRows<Dim>() = nodes;
  vtkNew<vtkPoints> points;
  points->SetData(vtk_array("positions", positions));
  grid.SetPoints(points);
  vtkNew<vtkCellArray> cells;
  for (vtkIdType i = 0; i < nodes.cols(); ++i) cells->InsertNextCell(1, &i);
  grid.SetCells(VTK_VERTEX, cells);
}

/// The text of a file that holds a grid.
std::string text_of(vtkUnstructuredGrid& grid) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(&grid);
  writer->SetDataModeToBinary();
  writer->SetHeaderTypeToUInt64();
  writer->WriteToOutputStringOn();
  if (writer->Write() != 1) throw WriteError("VTK cannot write the nodes as XML");
  return writer->GetOutputString();
}

/// Letters, digits, dots and underscores of a text, runs of anything else as one hyphen.
std::string safe(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_';
    if (plain) {
      result += c;
    } else if (!result.empty() && result.back() != '-') {
      result += '-';
    }
  }
  result.resize(std::min(result.size(), longest_part));
  while (!result.empty() && result.back() == '-') result.pop_back();
  return result;
}

/// Hash of a text. Source: Fowler, Noll and Vo, FNV-1a with 32 bits.
std::uint32_t hash_of(std::string_view text) {
  std::uint32_t hash = 2166136261U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return hash;
}

}  // namespace

NodeArray scalar_array(const std::string& name, std::span<const double> values) {
  return {name, Eigen::Map<const Eigen::RowVectorXd>(values.data(),
                                                     static_cast<Eigen::Index>(values.size()))};
}

NodeArray zone_array(const std::vector<Zone>& zones) {
  NodeArray array{"zone", Eigen::MatrixXd(1, zones.size())};
  for (std::size_t i = 0; i < zones.size(); ++i) {
    array.values(0, static_cast<Eigen::Index>(i)) = zones[i] == Zone::boundary ? 1 : 0;
  }
  return array;
}

template <int Dim>
std::string vtu_text(const Points<Dim>& nodes, const std::vector<NodeArray>& arrays,
                     const std::string& title, std::optional<double> time) {
  vtkNew<vtkUnstructuredGrid> grid;
  set_nodes<Dim>(*grid.Get(), nodes);
  for (const NodeArray& array : arrays) {
    if (array.values.cols() != nodes.cols()) {
      throw std::invalid_argument(fmt::format("array {} holds {} columns for {} nodes", array.name,
                                              array.values.cols(), nodes.cols()));
    }
    grid->GetPointData()->AddArray(vtk_array(array.name, array.values));
  }
  vtkNew<vtkStringArray> text;
  text->SetName("case");
  text->InsertNextValue(title);
  grid->GetFieldData()->AddArray(text);
  if (time) {
    grid->GetFieldData()->AddArray(vtk_array("TimeValue", Eigen::MatrixXd::Constant(1, 1, *time)));
  }
  return text_of(*grid.Get());
}

template <int Dim>
std::string cloud_text(const PointCloud<Dim>& cloud, std::vector<NodeArray> arrays,
                       const std::string& title, std::optional<double> time) {
  for (NodeArray& array : arrays) array.values = in_given_order(cloud, array.values);
  return vtu_text<Dim>(in_given_order(cloud, Eigen::MatrixXd(cloud.nodes)), arrays, title, time);
}

std::string title_of(const CaseKey& key) {
  return fmt::format("{}, {}, stencil {}, cloud {}, level {}", key.problem, key.method, key.stencil,
                     key.cloud, key.level);
}

std::string file_stem(const CaseKey& key, const std::string& rest) {
  const std::string more = fmt::format("{}|{}{}", key.form, key.solver, rest);
  const std::string level = key.level > 0 ? fmt::format("_{}", key.level) : "";
  return fmt::format("{}_{}_{}_{}{}_{:08x}", safe(key.problem), safe(key.method), safe(key.stencil),
                     safe(key.cloud), level, hash_of(title_of(key) + more));
}

std::string vtu_path(const VtkOutput& output, const CaseKey& key, const std::string& rest) {
  return fmt::format("{}/{}_{}.vtu", output.directory, output.study, file_stem(key, rest));
}

template <int Dim>
void write_vtu(const VtkOutput& output, const CaseKey& key, const PointCloud<Dim>& cloud,
               const std::vector<NodeArray>& arrays) {
  write_whole(vtu_path(output, key), cloud_text<Dim>(cloud, arrays, title_of(key)));
}

template std::string cloud_text<1>(const PointCloud<1>&, std::vector<NodeArray>, const std::string&,
                                   std::optional<double>);
template std::string vtu_text<1>(const Points<1>&, const std::vector<NodeArray>&,
                                 const std::string&, std::optional<double>);
template std::string cloud_text<2>(const PointCloud<2>&, std::vector<NodeArray>, const std::string&,
                                   std::optional<double>);
template std::string vtu_text<2>(const Points<2>&, const std::vector<NodeArray>&,
                                 const std::string&, std::optional<double>);
template std::string cloud_text<3>(const PointCloud<3>&, std::vector<NodeArray>, const std::string&,
                                   std::optional<double>);
template std::string vtu_text<3>(const Points<3>&, const std::vector<NodeArray>&,
                                 const std::string&, std::optional<double>);
template void write_vtu<1>(const VtkOutput&, const CaseKey&, const PointCloud<1>&,
                           const std::vector<NodeArray>&);
template void write_vtu<2>(const VtkOutput&, const CaseKey&, const PointCloud<2>&,
                           const std::vector<NodeArray>&);
template void write_vtu<3>(const VtkOutput&, const CaseKey&, const PointCloud<3>&,
                           const std::vector<NodeArray>&);

}  // namespace strongpoint
