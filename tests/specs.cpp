// Specs, options and registries.
#include <functional>

#include <gtest/gtest.h>

#include "methods/core/registry.hpp"
#include "problems/core/form.hpp"
#include "problems/core/layout.hpp"
#include "problems/core/problem.hpp"
#include "problems/core/solvers.hpp"

namespace strongpoint {
namespace {

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Specs, AreParsedWithNestedSpecsAsValues) {
  const Spec spec =
      parse_spec(" zoned[ interior = mfpm , boundary=lsfdm[order=3,weight=power[p=2]] ]");
  EXPECT_EQ(spec.name, "zoned");
  ASSERT_EQ(spec.arguments.size(), 2U);
  EXPECT_EQ(spec.arguments[0].second, "mfpm");
  EXPECT_EQ(spec.arguments[1].second, "lsfdm[order=3,weight=power[p=2]]");
  EXPECT_EQ(parse_spec(to_string(spec)), spec);
  EXPECT_EQ(split_specs("a[x=1,y=2],b, c[z=d[e=1,f=2]]"),
            (std::vector<std::string>{"a[x=1,y=2]", "b", "c[z=d[e=1,f=2]]"}));
}

TEST(Specs, ThatAreMalformedAreShownWithTheirMend) {
  for (const char* text : {"", "[k=3]", "nearest[k=3", "nearest k=3]", "nearest[k]", "nearest[k=]",
                           "nearest[k=3,k=4]", "nearest[k=3]x", "near est"}) {
    const std::string message = message_of([&] { parse_spec(text); });
    EXPECT_NE(message.find("name[key=value,...]"), std::string::npos) << text << ": " << message;
  }
}

TEST(Specs, NameWhatIsUnknownAndWhatIsAllowed) {
  const auto has = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  const std::string method = message_of([] { make_method<2>("mfpn"); });
  has(method, "mfpn");
  has(method, "lsfdm");
  const std::string key = message_of([] { make_method<2>("lsfdm[ordr=2]"); });
  has(key, "ordr");
  has(key, "order, weight");
  has(message_of([] { make_method<2>("lsfdm[order=9]"); }),
      "order=9 must be an integer from 1 to 8");
  has(message_of([] { make_method<2>("lsfdm[order=2.5]"); }), "2.5");
  has(message_of([] { make_rule<2>("nearest[ties=maybe]"); }), "keep, cut");
  has(message_of([] { make_rule<2>("grow_until[of=nowhere]"); }), "nowhere");
  has(message_of([] { make_problem("plate_hole[nu=0.6]"); }), "nu=0.6");
  has(message_of([] { make_problem("plate_hole[nu=nan]"); }), "nan");
  has(message_of([] { canonical_cloud("gird"); }), "scattered");
  has(message_of([] { canonical_solver("umfpak"); }), "sparse_lu");
  has(message_of([] { canonical_form("collocation[boundary=ghosts]"); }), "plain");
  has(message_of([] { make_method<2>("rbf_fd[phs=4]"); }), "odd");
  has(message_of([] { make_method<2>("rbf_fd[phs=7]"); }), "degree=3");
}

TEST(Specs, CanonicalFormDropsDefaultsAndCanBePastedBack) {
  EXPECT_EQ(make_method<2>("lsfdm[weight=bump4,order=2]").spec, "lsfdm");
  EXPECT_EQ(make_method<2>("lsfdm[weight=power[p=4],order=3]").spec, "lsfdm[order=3,weight=power]");
  EXPECT_EQ(make_rule<2>("grow_until[of=nearest[k=9,ties=keep]]").spec,
            "grow_until[of=nearest[k=9]]");
  EXPECT_EQ(make_problem("plate_hole[map=log,nu=0.3]").spec, "plate_hole[nu=0.3]");
  for (const MethodEntry& entry : methods()) {
    const std::string once = make_method<3>(entry.info.name).spec;
    EXPECT_EQ(make_method<3>(once).spec, once);
  }
}

TEST(Specs, EveryRegisteredThingDocumentsItselfAndItsOptions) {
  const auto check = [](const EntryInfo& info) {
    EXPECT_FALSE(info.name.empty());
    EXPECT_GT(info.summary.size(), 5U) << info.name;
    for (const OptionDoc& option : info.options) EXPECT_GT(option.doc.size(), 5U) << info.name;
  };
  for (const auto& entry : methods()) check(entry.info);
  for (const auto& entry : rules()) check(entry.info);
  for (const auto& entry : weight_functions()) check(entry.info);
  for (const auto& entry : problems()) check(entry.info);
  for (const auto& entry : layouts()) check(entry.info);
  for (const auto& entry : forms()) check(entry.info);
  for (const auto& info : solvers()) check(info);
}

}  // namespace
}  // namespace strongpoint
