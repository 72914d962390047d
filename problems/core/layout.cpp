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

namespace {

template <int Dim>
PointCloud<Dim> place_nodes(const LayoutEntry& entry, const Domain<Dim>& domain,
                            const Options& options, const LayoutRequest& request) {
  if constexpr (Dim == 1) return entry.make_1d(domain, options, request);
  if constexpr (Dim == 2) return entry.make_2d(domain, options, request);
  if constexpr (Dim == 3) return entry.make_3d(domain, options, request);
}

/// The cloud of a layout, along a curve unless it has a structure. Nodes have numbers of their own
/// when somebody else numbered them.
template <int Dim>
PointCloud<Dim> make_one(const LayoutEntry& entry, const Domain<Dim>& domain,
                         const Options& options, const LayoutRequest& request) {
  PointCloud<Dim> cloud = along_curve(place_nodes(entry, domain, options, request));
  if (entry.sizing != Sizing::by_file) cloud.numbers.clear();
  return cloud;
}

/// One cloud a patch, side by side.
template <int Dim>
PointCloud<Dim> make_patches(const LayoutEntry& entry, const Domain<Dim>& domain,
                             const Options& options, const LayoutRequest& request) {
  if (entry.sizing == Sizing::by_file) {
    throw SkipCase(
        fmt::format("a domain of several patches takes no cloud '{}'; take grid, blocks "
                    "or scattered",
                    entry.info.name));
  }
  CloudBuilder<Dim> builder;
  int patch = 0;
  for (const Domain<Dim>* piece : domain.patches()) {
    const PointCloud<Dim> cloud = make_one(entry, *piece, options, request);
    const std::vector<Part<Dim>> whole{{0, cloud.size(), 0, cloud.block}};
    for (const Part<Dim>& part : cloud.parts.empty() ? whole : cloud.parts) {
      builder.begin_part(patch, part.block);
      for (int i = part.first; i < part.first + part.count; ++i) {
        const auto marks = cloud.all_marks_of(i);
        builder.add(cloud.nodes.col(i), {marks.begin(), marks.end()});
      }
    }
    ++patch;
  }
  return builder.finish(domain.measure());
}

}  // namespace

template <int Dim>
PointCloud<Dim> make_cloud(const Domain<Dim>& domain, std::string_view spec,
                           const LayoutRequest& request) {
  const Spec parsed = parse_spec(spec);
  const LayoutEntry& entry = find_entry(layouts(), "cloud layout", parsed.name);
  const Options options(entry.info, parsed);
  if (request.level < 2 && entry.sizing == Sizing::by_level) {
    throw CaseError(fmt::format("level {}: at least 2 nodes a side are needed", request.level));
  }
  PointCloud<Dim> cloud = domain.patches().empty() ? make_one(entry, domain, options, request)
                                                   : make_patches(entry, domain, options, request);
  check_interfaces(cloud);
  return cloud;
}

template PointCloud<1> make_cloud(const Domain<1>&, std::string_view, const LayoutRequest&);
template PointCloud<2> make_cloud(const Domain<2>&, std::string_view, const LayoutRequest&);
template PointCloud<3> make_cloud(const Domain<3>&, std::string_view, const LayoutRequest&);

}  // namespace strongpoint
