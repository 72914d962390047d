// Stencils ordered by size against the library's sort.
#include "methods/core/size_order.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace strongpoint {
namespace {

/// Sizes and places as they come out; places are three apart.
std::vector<std::pair<int, int>> ordered(SizeOrder& order, const std::vector<int>& sizes) {
  order.begin(3 * sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) order.add(sizes[i], static_cast<int>(3 * i));
  std::vector<std::pair<int, int>> made;
  for (const SizeOrder::Entry& entry : order.arrange()) made.emplace_back(entry.size, entry.place);
  return made;
}

TEST(SizeOrder, IsBySizeThenByPlace) {
  SizeOrder order;  // the same for all: what one leaves must not reach the next
  const std::vector<std::vector<int>> cases{{},
                                            {7},
                                            {9, 9, 9},
                                            {6, 7, 9},
                                            {9, 7, 9, 6, 7, 9, 20, 6},
                                            {1000, 6, 100000, 6},  // too far apart to be counted
                                            {8, 8, 7}};
  for (const std::vector<int>& sizes : cases) {
    std::vector<std::pair<int, int>> sorted;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      sorted.emplace_back(sizes[i], static_cast<int>(3 * i));
    }
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(ordered(order, sizes), sorted) << sizes.size() << " sizes";
  }
}

}  // namespace
}  // namespace strongpoint
