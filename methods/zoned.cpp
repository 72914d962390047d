#include <algorithm>

#include <fmt/format.h>

#include "methods/core/local_method.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

template <int Dim>
class Zoned final : public Method<Dim> {
 public:
  Zoned(std::unique_ptr<Method<Dim>> interior, std::unique_ptr<Method<Dim>> boundary)
      : interior_(std::move(interior)), boundary_(std::move(boundary)) {}

  const Method<Dim>& in_zone(Zone zone) const override {
    return zone == Zone::interior ? *interior_ : *boundary_;
  }
  Needs needs() const override { return interior_->needs() | boundary_->needs(); }
  Promises promises() const override {
    const Promises a = interior_->promises();
    const Promises b = boundary_->promises();
    return {.reproduces = std::min(a.reproduces, b.reproduces),
            .scale_covariant = a.scale_covariant && b.scale_covariant,
            .interpolates = a.interpolates && b.interpolates,
            .local = a.local && b.local};
  }
  int stencil_size() const override {
    return std::max(interior_->stencil_size(), boundary_->stencil_size());
  }
  std::string default_stencil() const override {
    return fmt::format("zoned[interior={},boundary={}]", interior_->default_stencil(),
                       boundary_->default_stencil());
  }
  std::string unsupported(const Derivatives<Dim>& derivatives) const override {
    const std::string inside = interior_->unsupported(derivatives);
    return inside.empty() ? boundary_->unsupported(derivatives) : inside;
  }

  Weights weights(const Sites<Dim>& sites, const Stencils& stencils,
                  const Derivatives<Dim>& derivatives) const override {
    const auto part = [&](Zone zone) {
      return in_zone(zone).weights(sites, stencils_of(sites, stencils, zone), derivatives);
    };
    return joined_rows(part(Zone::interior), part(Zone::boundary));
  }

  std::vector<double> condition(const Sites<Dim>& sites, std::span<const int> anchors,
                                const Stencils& stencils, Scaling scaling,
                                ConditionNorm norm) const override {
    std::vector<double> result(anchors.size());
    for (const Zone zone : {Zone::interior, Zone::boundary}) {
      std::vector<int> chosen;
      Stencils chosen_stencils;
      std::vector<std::size_t> places;
      for (std::size_t i = 0; i < anchors.size(); ++i) {
        if (sites.anchor_zone[anchors[i]] != zone) continue;
        chosen.push_back(anchors[i]);
        chosen_stencils.push_back(stencils[static_cast<int>(i)]);
        places.push_back(i);
      }
      const auto part = in_zone(zone).condition(sites, chosen, chosen_stencils, scaling, norm);
      for (std::size_t i = 0; i < places.size(); ++i) result[places[i]] = part[i];
    }
    return result;
  }

 private:
  std::unique_ptr<Method<Dim>> interior_, boundary_;

  /// The stencils of one zone, the others empty.
  static Stencils stencils_of(const Sites<Dim>& sites, const Stencils& stencils, Zone zone) {
    Stencils chosen;
    for (int a = 0; a < stencils.size(); ++a) {
      chosen.push_back(sites.anchor_zone[a] == zone ? stencils[a] : std::span<const int>{});
    }
    return chosen;
  }
};

}  // namespace

/// One method inside, another at every node with a boundary mark.
/// Source: numerical experience that what is right inside is often wrong at a traction boundary.
MethodEntry method_zoned() {
  return {{"zoned",
           "one method inside, another at boundary nodes",
           {{"interior", "mfpm", "method at interior nodes"},
            {"boundary", "lsfdm", "method at boundary nodes"}}},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>,
                                                 Options& options) -> std::unique_ptr<Method<Dim>> {
            Named<Method<Dim>> interior = make_method<Dim>(options.text("interior"));
            Named<Method<Dim>> boundary = make_method<Dim>(options.text("boundary"));
            options.set("interior", interior.spec);
            options.set("boundary", boundary.spec);
            for (const Named<Method<Dim>>* method : {&interior, &boundary}) {
              if (method->made->promises().local) continue;
              throw UsageError(
                  fmt::format("zoned: {} uses every node of the cloud and cannot stand "
                              "in a zone; name a local method",
                              method->spec));
            }
            return std::make_unique<Zoned<Dim>>(std::move(interior.made), std::move(boundary.made));
          })};
}

}  // namespace strongpoint
