#include "tests/file_checks.hpp"

namespace strongpoint {
namespace {

using CsvFiles = FileTest;

/// Writes a cloud of the unit cube as a table, normals included where there is one.
template <int Dim>
std::string csv_of(const PointCloud<Dim>& cloud) {
  const UnitCube<Dim> cube;
  std::string text = Dim == 2 ? "x,y,tag,nx,ny\n" : "x,y,z,tag,nx,ny,nz\n";
  for (int i = 0; i < cloud.size(); ++i) {
    std::string tag, normal(Dim, ',');
    for (const auto& mark : cloud.marks_of(i)) {
      tag += (tag.empty() ? "" : "+") + cube.sides()[mark.side];
      if (cloud.marks_of(i).size() > 1) continue;
      normal.clear();
      for (int c = 0; c < Dim; ++c) normal += fmt::format(",{:.17g}", mark.normal[c]);
    }
    for (int c = 0; c < Dim; ++c) text += fmt::format("{:.17g},", cloud.nodes(c, i));
    text += tag + normal + "\n";
  }
  return text;
}

template <int Dim>
void expect_same(const PointCloud<Dim>& a, const PointCloud<Dim>& b) {
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.mark_offsets, b.mark_offsets);
  EXPECT_EQ(a.measure, b.measure);
  ASSERT_EQ(a.marks.size(), b.marks.size());
  for (std::size_t m = 0; m < a.marks.size(); ++m) {
    EXPECT_EQ(a.marks[m].side, b.marks[m].side);
    EXPECT_EQ(a.marks[m].normal, b.marks[m].normal);
  }
}

TEST_F(CsvFiles, GiveBackATableOfNodes) {
  const PointCloud<2> plane = make_cloud<2>(UnitCube<2>(), "perturbed", {6, 3});
  expect_same(load<2>(UnitCube<2>(), write("plane.csv", csv_of(plane))), plane);
  const PointCloud<3> space = make_cloud<3>(UnitCube<3>(), "scattered", {4, 3});
  expect_same(load<3>(UnitCube<3>(), write("space.csv", csv_of(space))), space);
}

TEST_F(CsvFiles, ReadTagsNumbersAndNormals) {
  const PointCloud<2> cloud = load<2>(UnitCube<2>(), write("a.csv",
                                                           "\xEF\xBB\xBFx, y, tag, nx, ny\r\n"
                                                           "0.5,+5e-1,interior,,\r\n"
                                                           "0.25,0.5,0,7,7\r\n"
                                                           "\r\n"
                                                           "0,0.5,left,-3,4\r\n"
                                                           "1,0.5,2,,\r\n"
                                                           "0,0, bottom + 1 ,1,1\r\n"
                                                           "0.75,0.5,,,"));
  ASSERT_EQ(cloud.size(), 6);
  EXPECT_EQ(cloud.nodes(1, 0), 0.5);
  for (int inside : {0, 1, 5}) EXPECT_FALSE(cloud.is_boundary(inside));
  EXPECT_LT((cloud.marks_of(2)[0].normal - Point<2>(-0.6, 0.8)).norm(), round_off);
  EXPECT_EQ(cloud.marks_of(3)[0].side, 1);
  EXPECT_EQ(cloud.marks_of(3)[0].normal, Point<2>(1, 0));
  ASSERT_EQ(cloud.marks_of(4).size(), 2U);
  EXPECT_EQ(cloud.marks_of(4)[0].normal, Point<2>(-1, 0));
  EXPECT_EQ(cloud.marks_of(4)[1].side, 2);
}

TEST_F(CsvFiles, ReadATableWithoutNormalsInOneDimension) {
  const std::string file = write("a.csv", "x,tag\n0,left\n1,right\n0.5,\n");
  const PointCloud<1> cloud = load<1>(UnitCube<1>(), file);
  ASSERT_EQ(cloud.size(), 3);
  EXPECT_EQ(cloud.marks_of(0)[0].normal[0], -1);
  EXPECT_EQ(cloud.marks_of(1)[0].normal[0], 1);
  EXPECT_FALSE(cloud.is_boundary(2));
}

TEST_F(CsvFiles, NameThePlaceOfABadCell) {
  const auto complaint = [this](const std::string& text) {
    return refusal<2>(write("a.csv", text));
  };
  const std::string head = "x,y,tag,nx,ny\n0,0,left,-1,0\n";
  STRONGPOINT_EXPECT_IN("line 3, column 2 (y): 'abc' is not a number",
                        complaint(head + "0,abc,,,\n"));
  STRONGPOINT_EXPECT_IN("line 3, column 1 (x): '' is not a number", complaint(head + ",1,,,\n"));
  STRONGPOINT_EXPECT_IN("line 3, column 1 (x): 'nan' is not finite",
                        complaint(head + "nan,1,,,\n"));
  STRONGPOINT_EXPECT_IN("line 3, column 2 (y): 'inf' is not finite",
                        complaint(head + "0,inf,,,\n"));
  STRONGPOINT_EXPECT_IN(
      "line 3, column 3 (tag): 'roof' is not a side; known: left, right, bottom, top",
      complaint(head + "0,1,roof,,\n"));
  STRONGPOINT_EXPECT_IN("(tag): '5' is not a side", complaint(head + "0,1,5,,\n"));
  STRONGPOINT_EXPECT_IN("(tag): '' is not a side", complaint(head + "0,1,left+,,\n"));
  STRONGPOINT_EXPECT_IN("line 3: 4 cells where the header has 5", complaint(head + "0,1,left,1\n"));
  STRONGPOINT_EXPECT_IN("line 3, column 4 (nx): the normal has length zero",
                        complaint(head + "0,1,left,0,0\n"));
  STRONGPOINT_EXPECT_IN("line 3, column 5 (ny): '' is not a number",
                        complaint(head + "0,1,left,1,\n"));
  STRONGPOINT_EXPECT_IN("nodes 0 and 1 coincide", complaint(head + "0,0,,,\n"));
  STRONGPOINT_EXPECT_IN("at least 2", complaint(head));
}

TEST_F(CsvFiles, NameAWrongColumn) {
  const auto complaint = [this](const std::string& text) {
    return refusal<2>(write("a.csv", text));
  };
  STRONGPOINT_EXPECT_IN("line 1, column 3: 'side' is not expected here", complaint("x,y,side\n"));
  STRONGPOINT_EXPECT_IN("must be x,y,tag or x,y,tag,nx,ny", complaint("x,y,side\n"));
  STRONGPOINT_EXPECT_IN("line 1, column 3: 'tag' is missing", complaint("x,y\n"));
  STRONGPOINT_EXPECT_IN("line 1, column 5: 'ny' is missing", complaint("x,y,tag,nx\n"));
  STRONGPOINT_EXPECT_IN("line 1, column 3: 'z' is not expected", complaint("x,y,z,tag\n"));
  STRONGPOINT_EXPECT_IN("column 6: 'nz' is not expected", complaint("x,y,tag,nx,ny,nz\n"));
  STRONGPOINT_EXPECT_IN("is empty", complaint(""));
}

}  // namespace
}  // namespace strongpoint
