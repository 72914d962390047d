#include "problems/core/damping.hpp"

#include <cmath>

namespace strongpoint {
namespace {

constexpr double largest_strength = 100;

Damping parse(const Options& options, const std::string& name) {
  if (name == "stiffness") {
    return {Damping::Kind::stiffness, options.number("eta", 0, largest_strength)};
  }
  if (name == "hyper") return {Damping::Kind::hyper, options.number("g", 0, largest_strength)};
  return {};
}

struct DampingEntry {
  EntryInfo info;
};

const std::vector<DampingEntry>& entries() {
  static const std::vector<DampingEntry> all{
      {{"none", "no damping", {}}},
      {{"stiffness",
        "u'' = K (u + eta q u'), q from node to node at the speed of waves",
        {{"eta", "0.02", "strength, 0 to 100"}}}},
      {{"hyper",
        "hyperviscosity, u'' = K (u - g q^3 K u'): an error of third order",
        {{"g", "0.02", "strength, 0 to 100"}}}}};
  return all;
}

}  // namespace

const std::vector<EntryInfo>& dampings() {
  static const std::vector<EntryInfo> infos = [] {
    std::vector<EntryInfo> list;
    for (const DampingEntry& entry : entries()) list.push_back(entry.info);
    return list;
  }();
  return infos;
}

std::string canonical_damping(std::string_view text) {
  const Spec spec = parse_spec(text);
  const Options options(find_entry(entries(), "damping", spec.name).info, spec);
  parse(options, spec.name);  // refuses values that do not fit
  return options.canonical();
}

Damping make_damping(std::string_view text) {
  const Spec spec = parse_spec(text);
  return parse(Options(find_entry(entries(), "damping", spec.name).info, spec), spec.name);
}

DampedMotion::DampedMotion(const Motion& motion, const Damping& damping, double node_time)
    : motion_(motion), damping_(damping), node_time_(node_time), work_(motion.size()) {}

void DampedMotion::accelerate(const Eigen::VectorXd& u, const Eigen::VectorXd& velocity,
                              double load, Eigen::VectorXd& acceleration) const {
  switch (damping_.kind) {
    case Damping::Kind::none:
      motion_.apply(u, acceleration);
      break;
    case Damping::Kind::stiffness:
      work_ = u + stiffness_time() * velocity;
      motion_.apply(work_, acceleration);
      break;
    case Damping::Kind::hyper:
      motion_.apply(velocity, work_);
      work_ = u - damping_.strength * std::pow(node_time_, 3) * work_;
      motion_.apply(work_, acceleration);
      break;
  }
  if (load != 0) acceleration += load * motion_.load();
}

}  // namespace strongpoint
