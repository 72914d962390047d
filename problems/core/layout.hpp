#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "methods/core/options.hpp"
#include "problems/core/domain.hpp"

namespace strongpoint {

/// What a cloud is made for.
struct LayoutRequest {
  int level = 0;           ///< nodes along the reference side
  std::uint64_t seed = 1;  ///< used by random layouts whose spec gives none
};

/// What decides how many nodes a layout makes.
enum class Sizing {
  by_level,  ///< the level asked for
  by_file    ///< the file the nodes are read from; levels mean nothing
};

/// A way to place nodes in a domain. Makers throw SkipCase when the domain cannot be served and
/// CaseError when the cloud is bad.
struct LayoutEntry {
  EntryInfo info;
  PointCloud<1> (*make_1d)(const Domain<1>&, const Options&, const LayoutRequest&);
  PointCloud<2> (*make_2d)(const Domain<2>&, const Options&, const LayoutRequest&);
  PointCloud<3> (*make_3d)(const Domain<3>&, const Options&, const LayoutRequest&);
  Sizing sizing = Sizing::by_level;
};

/// A layout entry from a stateless generic lambda
/// `[]<int Dim>(const Domain<Dim>&, const Options&, const LayoutRequest&)`.
template <class Maker>
LayoutEntry layout_entry(EntryInfo info, Maker, Sizing sizing = Sizing::by_level) {
  return {
      std::move(info),
      [](const Domain<1>& d, const Options& o, const LayoutRequest& r) { return Maker{}(d, o, r); },
      [](const Domain<2>& d, const Options& o, const LayoutRequest& r) { return Maker{}(d, o, r); },
      [](const Domain<3>& d, const Options& o, const LayoutRequest& r) { return Maker{}(d, o, r); },
      sizing};
}

/// All registered layouts, in the order of layouts.def.
const std::vector<LayoutEntry>& layouts();

/// Canonical form of a cloud spec. Throws UsageError when it is malformed or unknown.
std::string canonical_cloud(std::string_view spec);

/// Makes the cloud a spec describes, for a domain and a level of at least 2 nodes a side.
template <int Dim>
PointCloud<Dim> make_cloud(const Domain<Dim>& domain, std::string_view spec,
                           const LayoutRequest& request);

}  // namespace strongpoint
