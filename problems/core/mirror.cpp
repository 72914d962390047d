#include "problems/core/mirror.hpp"

#include <algorithm>
#include <cmath>

namespace strongpoint {
namespace {

/// How far images reach, in spacings: beyond the radius of a one-sided stencil of degree 8 in the
/// plane (92 nodes) and of degree 4 in space (150 nodes).
template <int Dim>
constexpr double reach = Dim == 3 ? 6 : 10;

/// Nodes closer to a plane than this fraction of their spacing lie on it.
constexpr double on_plane = 1e-6;

/// Axes of a set of planes as bits; 0 when two of them share an axis.
unsigned axes_of(const std::vector<SymmetryPlane>& planes, unsigned chosen) {
  unsigned axes = 0;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    if ((chosen >> p & 1U) == 0) continue;
    const unsigned axis = 1U << static_cast<unsigned>(planes[p].axis);
    if ((axes & axis) != 0) return 0;
    axes |= axis;
  }
  return axes;
}

}  // namespace

Symmetry symmetry_choice(const Options& options) {
  return options.choice<Symmetry>(
      "symmetry",
      {{"default", Symmetry::by_default}, {"rows", Symmetry::rows}, {"images", Symmetry::images}});
}

template <int Dim>
std::vector<SymmetryPlane> mirrored_planes(const SteadyProblem<Dim>& problem, Symmetry symmetry) {
  const bool images =
      symmetry == Symmetry::images || (symmetry == Symmetry::by_default && Dim == 3);
  return images ? problem.symmetry_planes() : std::vector<SymmetryPlane>{};
}

template <int Dim>
void append_images(const std::vector<SymmetryPlane>& planes, const Eigen::VectorXd& spacing,
                   Sites<Dim>& sites, NodeUnknowns& unknowns) {
  if (planes.empty()) return;
  const int count = sites.node_count();
  std::vector<Point<Dim>> images;
  unknowns.source.resize(count);
  for (int i = 0; i < count; ++i) unknowns.source[i] = i;
  unknowns.mirrored.assign(count, 0);
  for (unsigned chosen = 1; chosen < 1U << planes.size(); ++chosen) {
    const unsigned axes = axes_of(planes, chosen);
    if (axes == 0) continue;
    for (int i = 0; i < count; ++i) {
      Point<Dim> image = sites.nodes.col(i);
      bool is_near = true;
      for (std::size_t p = 0; p < planes.size(); ++p) {
        if ((chosen >> p & 1U) == 0) continue;
        double& x = image[planes[p].axis];
        const double distance = std::abs(x - planes[p].offset);
        is_near = is_near && distance > on_plane * spacing[i] && distance < reach<Dim> * spacing[i];
        x = 2 * planes[p].offset - x;
      }
      if (!is_near) continue;
      images.push_back(image);
      unknowns.source.push_back(i);
      unknowns.mirrored.push_back(static_cast<std::uint8_t>(axes));
    }
  }
  sites.nodes.conservativeResize(Eigen::NoChange, count + static_cast<int>(images.size()));
  for (std::size_t k = 0; k < images.size(); ++k) {
    sites.nodes.col(count + static_cast<int>(k)) = images[k];
  }
  sites.block.reset();
}

template std::vector<SymmetryPlane> mirrored_planes(const SteadyProblem<1>&, Symmetry);
template std::vector<SymmetryPlane> mirrored_planes(const SteadyProblem<2>&, Symmetry);
template std::vector<SymmetryPlane> mirrored_planes(const SteadyProblem<3>&, Symmetry);
template void append_images(const std::vector<SymmetryPlane>&, const Eigen::VectorXd&, Sites<1>&,
                            NodeUnknowns&);
template void append_images(const std::vector<SymmetryPlane>&, const Eigen::VectorXd&, Sites<2>&,
                            NodeUnknowns&);
template void append_images(const std::vector<SymmetryPlane>&, const Eigen::VectorXd&, Sites<3>&,
                            NodeUnknowns&);

}  // namespace strongpoint
