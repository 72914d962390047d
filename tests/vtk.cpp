#include "studies/support/vtk.hpp"

#include <bit>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <gtest/gtest.h>

namespace strongpoint {
namespace {

/// What VTK reads in a text.
vtkNew<vtkXMLUnstructuredGridReader> read(const std::string& text) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(text);
  reader->Update();
  return reader;
}

/// Numbers that a text with too few digits, or arithmetic, would change, (1, 8).
Eigen::MatrixXd awkward_numbers() {
  using Limits = std::numeric_limits<double>;
  return Eigen::RowVector<double, 8>{std::numbers::pi,    -0.0,
                                     Limits::quiet_NaN(), Limits::infinity(),
                                     -Limits::infinity(), Limits::denorm_min(),
                                     -Limits::max(),      1.0 / 3};
}

void expect_same_bits(vtkDataArray* array, const Eigen::MatrixXd& values) {
  ASSERT_NE(array, nullptr);
  ASSERT_EQ(array->GetNumberOfComponents(), values.rows());
  ASSERT_EQ(array->GetNumberOfTuples(), values.cols());
  for (Eigen::Index i = 0; i < values.cols(); ++i) {
    for (int c = 0; c < values.rows(); ++c) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(array->GetComponent(i, c)),
                std::bit_cast<std::uint64_t>(values(c, i)))
          << array->GetName() << ", node " << i << ", component " << c;
    }
  }
}

template <int Dim>
void expect_numbers_to_come_back() {
  const std::string title = "a <case> & \"its\" name, \xc3\xa9";
  const Eigen::MatrixXd scalar = awkward_numbers();
  const Points<Dim> nodes = Points<Dim>::Random(Dim, scalar.cols());
  Eigen::MatrixXd vector = Eigen::MatrixXd::Random(3, scalar.cols());
  vector(1, 2) = std::numeric_limits<double>::quiet_NaN();
  const auto reader = read(vtu_text<Dim>(nodes, {{"vector", vector}, {"scalar", scalar}}, title));
  vtkUnstructuredGrid& grid = *reader->GetOutput();
  ASSERT_EQ(grid.GetPointData()->GetNumberOfArrays(), 2);
  expect_same_bits(grid.GetPointData()->GetArray("vector"), vector);
  expect_same_bits(grid.GetPointData()->GetArray("scalar"), scalar);
  Eigen::MatrixXd positions = Eigen::MatrixXd::Zero(3, nodes.cols());
  positions.topRows<Dim>() = nodes;
  expect_same_bits(grid.GetPoints()->GetData(), positions);
  auto* text = vtkStringArray::SafeDownCast(grid.GetFieldData()->GetAbstractArray("case"));
  ASSERT_NE(text, nullptr);
  EXPECT_EQ(text->GetValue(0), title);
}

TEST(Vtk, NumbersComeBackToTheBitOnALine) { expect_numbers_to_come_back<1>(); }
TEST(Vtk, NumbersComeBackToTheBitInAPlane) { expect_numbers_to_come_back<2>(); }
TEST(Vtk, NumbersComeBackToTheBitInSpace) { expect_numbers_to_come_back<3>(); }

TEST(Vtk, TheSameNodesGiveTheSameText) {
  const Points<2> nodes = Points<2>::Random(2, 50);
  const std::vector<NodeArray> arrays{{"u", nodes.row(0)}};
  EXPECT_EQ(vtu_text<2>(nodes, arrays, "title"), vtu_text<2>(nodes, arrays, "title"));
}

TEST(Vtk, RefusesAnArrayThatDoesNotFitTheNodes) {
  EXPECT_THROW(
      vtu_text<2>(Points<2>::Zero(2, 3), {scalar_array("u", std::vector<double>{1, 2})}, "title"),
      std::invalid_argument);
}

TEST(Vtk, FilesOfDifferentCasesHaveDifferentSafeNames) {
  const VtkOutput output{"maps", "conditioning"};
  const CaseKey key{"field",   "mfpm", "nearest[k=9]", "file[path=/a b/c.csv]", "collocation",
                    "umfpack", 0};
  const std::string path = vtu_path(output, key);
  EXPECT_EQ(path.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-./"), std::string::npos)
      << path;
  EXPECT_EQ(path.find('/'), path.rfind('/')) << path;
  CaseKey other = key;
  other.stencil = "nearest[k-9]";  // the same once made safe
  EXPECT_NE(vtu_path(output, other), path);
  other = key;
  other.solver = "bicgstab";
  EXPECT_NE(vtu_path(output, other), path);
}

}  // namespace
}  // namespace strongpoint
