#include "problems/core/layout.hpp"

namespace strongpoint {

#define LAYOUT(name) LayoutEntry layout_##name();
#include "problems/core/layouts/layouts.def"
#undef LAYOUT

const std::vector<LayoutEntry>& layouts() {
  static const std::vector<LayoutEntry> all{
#define LAYOUT(name) layout_##name(),
#include "problems/core/layouts/layouts.def"
#undef LAYOUT
  };
  return all;
}

std::string canonical_cloud(std::string_view spec) {
  const Spec parsed = parse_spec(spec);
  return Options(find_entry(layouts(), "cloud layout", parsed.name).info, parsed).canonical();
}

template <int Dim>
PointCloud<Dim> make_cloud(const Domain<Dim>& domain, std::string_view spec,
                           const LayoutRequest& request) {
  const Spec parsed = parse_spec(spec);
  const LayoutEntry& entry = find_entry(layouts(), "cloud layout", parsed.name);
  const Options options(entry.info, parsed);
  if (request.level < 2 && entry.sizing == Sizing::by_level) {
    throw CaseError(fmt::format("level {}: at least 2 nodes a side are needed", request.level));
  }
  if constexpr (Dim == 1) return entry.make_1d(domain, options, request);
  if constexpr (Dim == 2) return entry.make_2d(domain, options, request);
  if constexpr (Dim == 3) return entry.make_3d(domain, options, request);
}

template PointCloud<1> make_cloud(const Domain<1>&, std::string_view, const LayoutRequest&);
template PointCloud<2> make_cloud(const Domain<2>&, std::string_view, const LayoutRequest&);
template PointCloud<3> make_cloud(const Domain<3>&, std::string_view, const LayoutRequest&);

}  // namespace strongpoint
