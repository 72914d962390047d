#include "problems/core/cell_faces.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <omp.h>

#include "methods/core/error.hpp"
#include "problems/core/cell_visits.hpp"
#include "problems/core/face_makers.hpp"

namespace strongpoint {
namespace {

/// The points of all cells as threads make them, by thread.
template <int Dim>
class PointStore {
 public:
  PointStore(int nodes, int threads) : places_(nodes), by_thread_(threads) {}

  std::vector<FacePoint<Dim>>& of_thread(int thread) { return by_thread_[thread]; }
  void note(int node, int thread, std::size_t first, std::size_t end) {
    places_[node] = {thread, first, end};
  }
  /// Everything in the order of the nodes.
  CellFaces<Dim> collect() const {
    CellFaces<Dim> faces;
    for (const Place& place : places_) {
      faces.offsets.push_back(faces.offsets.back() +
                              static_cast<std::int64_t>(place.end - place.first));
    }
    faces.points.resize(static_cast<std::size_t>(faces.offsets.back()));
#pragma omp parallel for schedule(static)
    for (int node = 0; node < static_cast<int>(places_.size()); ++node) {
      const Place& place = places_[node];
      const std::vector<FacePoint<Dim>>& source = by_thread_[place.thread];
      std::copy(source.begin() + static_cast<std::ptrdiff_t>(place.first),
                source.begin() + static_cast<std::ptrdiff_t>(place.end),
                faces.points.begin() + faces.offsets[node]);
    }
    return faces;
  }

 private:
  struct Place {
    int thread = 0;
    std::size_t first = 0, end = 0;
  };
  std::vector<Place> places_;
  std::vector<std::vector<FacePoint<Dim>>> by_thread_;
};

/// How far the sum of the cells may be from the domain: curved sides in space on the coarsest
/// clouds err by 3e-3 with one point a face, all else by less than 1e-4.
template <int Dim>
constexpr double measure_tolerance = Dim == 3 ? 1e-2 : 1e-3;

/// Throws unless every cell has a positive measure and all together have that of the domain.
template <int Dim>
void check_cells(const PointCloud<Dim>& cloud, const Domain<Dim>& domain,
                 const CellFaces<Dim>& faces) {
  double sum = 0;
  for (int i = 0; i < cloud.size(); ++i) {
    const Point<Dim> centre = cloud.nodes.col(i);
    const double measure = cell_measure<Dim>(centre, faces.of(i));
    sum += measure;
    if (measure > 0 && std::isfinite(measure)) continue;
    throw CaseError(
        fmt::format("the faces of the Voronoi cell of node {} at {} enclose {:g}: move the node "
                    "into the domain, or remove the nodes that coincide with it",
                    cloud.number_of(i), format_point(centre), measure));
  }
  const double whole = domain.measure();
  if (std::abs(sum - whole) > measure_tolerance<Dim> * whole) {
    throw CaseError(
        fmt::format("the Voronoi cells measure {:.6g}, the domain {:.6g}: cells miss parts of the "
                    "boundary; put nodes on it, or refine the cloud",
                    sum, whole));
  }
}

}  // namespace

template <int Dim>
CellFaces<Dim> cell_faces(const PointCloud<Dim>& cloud, const Domain<Dim>& domain,
                          const NeighbourSearch<Dim>& search, int gauss) {
  if (gauss < 1 || gauss > 4) {
    throw std::invalid_argument(fmt::format("cell_faces: {} points a face; give 1 to 4", gauss));
  }
  const FaceSetting<Dim> setting(cloud, domain, gauss);
  PointStore<Dim> store(cloud.size(), omp_get_max_threads());
  visit_cells(cloud, search, [&] {
    const int thread = omp_get_thread_num();
    return [&, thread, maker = FaceMaker<Dim>(setting)](const CellBlock& block) mutable {
      std::vector<FacePoint<Dim>>& points = store.of_thread(thread);
      for (int i = 0; i < block.size(); ++i) {
        const int node = block.nodes[i];
        const std::size_t before = points.size();
        const CellOutcome outcome =
            add_settled(cloud, maker, node, block.neighbours(i), block.reaches[i], points);
        if (outcome.state != CellState::settled) points.resize(before);
        store.note(node, thread, before, points.size());
        block.wanted[i] = outcome.state == CellState::open ? 2 * outcome.farthest : 0;
      }
    };
  });
  CellFaces<Dim> faces = store.collect();
  check_cells(cloud, domain, faces);
  return faces;
}

template CellFaces<1> cell_faces<1>(const PointCloud<1>&, const Domain<1>&,
                                    const NeighbourSearch<1>&, int);
template CellFaces<2> cell_faces<2>(const PointCloud<2>&, const Domain<2>&,
                                    const NeighbourSearch<2>&, int);
template CellFaces<3> cell_faces<3>(const PointCloud<3>&, const Domain<3>&,
                                    const NeighbourSearch<3>&, int);

}  // namespace strongpoint
