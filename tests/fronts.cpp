// Time against error: which rows are on the front, and what it takes to reach an error.
#include "studies/support/fronts.hpp"

#include <gtest/gtest.h>

#include "studies/support/exponents.hpp"

namespace strongpoint {
namespace {

/// A row of a method at a level, with an error and a total time.
Row row_of(const std::string& method, int level, double error, double seconds) {
  Row row;
  row.key.problem = std::string("p");
  row.key.method = method;
  row.key.level = level;
  row.quantity = std::string("u_error");
  row.value = error;
  row.nodes = level;
  row.times = StageTimes{.weights = seconds / 4, .solve = seconds * 3 / 4};
  row.extra = {"", ""};
  return row;
}

/// Two methods of which the second is better below 1e-3 only.
std::vector<std::vector<Row>> two_methods() {
  return {{row_of("a", 1, 5e-2, 1)},   {row_of("a", 2, 8e-3, 2)}, {row_of("a", 3, 2e-3, 8)},
          {row_of("b", 1, 5e-1, 1.5)}, {row_of("b", 2, 8e-3, 4)}, {row_of("b", 3, 1e-6, 7)}};
}

TEST(Fronts, ARowThatIsBeatenInTimeAndErrorIsNotOnTheFront) {
  std::vector<std::vector<Row>> cases = two_methods();
  mark_fronts(cases);
  std::vector<std::string> marks;
  marks.reserve(cases.size());
  for (const std::vector<Row>& rows : cases) marks.push_back(rows.front().extra[0]);
  EXPECT_EQ(marks, (std::vector<std::string>{"front", "front", "", "", "", "front"}));
}

TEST(Fronts, QuantitiesAndProblemsAreComparedAmongThemselves) {
  std::vector<std::vector<Row>> cases = two_methods();
  cases[3].front().quantity = std::string("v_error");
  cases[4].front().key.problem = std::string("q");
  mark_fronts(cases);
  EXPECT_EQ(cases[3].front().extra[0], "front");
  EXPECT_EQ(cases[4].front().extra[0], "front");
}

TEST(Fronts, RowsWithoutAValueTakeNoPart) {
  std::vector<std::vector<Row>> cases = two_methods();
  cases[0].front().status = Status::failed;
  cases[1].front().times.reset();
  mark_fronts(cases);
  EXPECT_EQ(cases[0].front().extra[0], "");
  EXPECT_EQ(cases[1].front().extra[0], "");
  EXPECT_EQ(cases[3].front().extra[0], "front");
}

TEST(Fronts, TheTimeToReachAnErrorIsTheLeastOfTheLevelsThatDo) {
  const std::vector<ReachTable> tables = reach_tables(two_methods());
  ASSERT_EQ(tables.size(), 1U);
  ASSERT_EQ(tables[0].choices.size(), 2U);
  const ReachTimes& best = tables[0].choices[0];
  EXPECT_EQ(best.key.method, "b");  // it reaches the tightest tolerance
  EXPECT_EQ(best.seconds[0], 4.0);
  EXPECT_EQ(best.seconds[1], 7.0);
  EXPECT_EQ(best.seconds[4], 7.0);
  EXPECT_FALSE(best.seconds[5].has_value());
  const ReachTimes& other = tables[0].choices[1];
  EXPECT_EQ(other.seconds[0], 2.0);
  EXPECT_FALSE(other.seconds[1].has_value());
}

TEST(Fronts, AChoiceThatReachesNothingIsLeftOut) {
  std::vector<std::vector<Row>> cases = two_methods();
  for (int i : {0, 1, 2}) cases[i].front().value = 0.5;
  EXPECT_EQ(reach_tables(cases)[0].choices.size(), 1U);
}

TEST(Exponents, APowerOfTheNumberOfNodesIsFoundToRoundOff) {
  std::vector<std::vector<Row>> cases;
  for (int level : {10, 100, 1000}) cases.push_back({row_of("a", level, 3e-6 * level * level, 1)});
  fit_exponents(cases, 1);
  for (const std::vector<Row>& rows : cases) EXPECT_EQ(rows.front().extra[1], "2.000");
}

TEST(Exponents, OneLevelLeavesTheExponentOpen) {
  std::vector<std::vector<Row>> cases{{row_of("a", 10, 1, 1)}, {row_of("b", 20, 1, 1)}};
  fit_exponents(cases, 1);
  EXPECT_EQ(cases[0].front().extra[1], "");
}

}  // namespace
}  // namespace strongpoint
