#include "studies/support/seeds.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/options.hpp"
#include "problems/core/layout.hpp"

namespace strongpoint {

std::vector<std::string> with_seeds(const std::string& cloud, std::uint64_t seed, int count) {
  const Spec spec = parse_spec(cloud);
  const EntryInfo& info = find_entry(layouts(), "cloud", spec.name).info;
  const auto is_seed = [](const auto& option) { return option.key == "seed"; };
  if (std::none_of(info.options.begin(), info.options.end(), is_seed)) return {cloud};
  Spec rest = spec;
  std::uint64_t first = seed;
  std::erase_if(rest.arguments, [&](const auto& argument) {
    if (argument.first != "seed") return false;
    first = std::stoull(argument.second);  // canonical specs hold checked integers
    return true;
  });
  constexpr std::uint64_t largest = std::numeric_limits<int>::max();  // what layouts take
  const std::uint64_t last = first + static_cast<std::uint64_t>(count - 1);
  if (last > largest) {
    throw UsageError(
        fmt::format("--seeds {}: the cloud {} would be made with seeds up to {}, above "
                    "{}; give a smaller seed or fewer of them",
                    count, cloud, last, largest));
  }
  std::vector<std::string> clouds;
  for (int i = 0; i < count; ++i) {
    Spec one = rest;
    one.arguments.emplace_back("seed", fmt::format("{}", first + i));
    clouds.push_back(to_string(one));
  }
  return clouds;
}

CaseResult median_of(const std::vector<CaseResult>& results) {
  CaseResult joined = results.front();
  for (std::size_t q = 0; q < joined.quantities.size(); ++q) {
    std::vector<double> values;
    for (const CaseResult& result : results) {
      if (result.quantities[q].value) values.push_back(*result.quantities[q].value);
    }
    Quantity& quantity = joined.quantities[q];
    quantity.extra = {fmt::format("{}", values.size()), "", ""};
    if (values.empty()) continue;
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    quantity.value =
        values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
    quantity.reason.clear();
    quantity.extra = {fmt::format("{}", values.size()), fmt::format("{}", values.front()),
                      fmt::format("{}", values.back())};
  }
  return joined;
}

}  // namespace strongpoint
