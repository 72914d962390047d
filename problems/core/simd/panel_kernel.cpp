#include "problems/core/simd/panel_kernel.hpp"

#include "problems/core/simd/real_packs.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

template <class Real>
constexpr int front_packs = front_tile<Real> / width<Real>;

/// Pivots whose sums are kept at a time.
constexpr int pivots_summed = 32;

template <class Real>
void multiply(const PanelTask<Real>& t) {
  const Real* panel = t.panel;
  for (int r = 0; r < t.rest; r += front_tile<Real>) {
    PackOf<Real> sums[front_packs<Real>];
    for (int q = 0; q < front_packs<Real>; ++q) sums[q] = all(Real{0});
    for (int k = 0; k < t.pivots; ++k, panel += front_tile<Real>) {
      fetch_ahead(panel);
      const PackOf<Real> value = all(t.values[k]);
      for (int q = 0; q < front_packs<Real>; ++q)
        sums[q] = sums[q] + value * load(panel + q * width<Real>);
    }
    for (int q = 0; q < front_packs<Real>; ++q) store(t.beside + r + q * width<Real>, sums[q]);
  }
}

template <class Real>
void subtract_turned(const PanelTask<Real>& t) {
  for (int first = 0; first < t.pivots; first += pivots_summed) {
    const int count = t.pivots - first < pivots_summed ? t.pivots - first : pivots_summed;
    PackOf<Real> sums[pivots_summed];
    for (int k = 0; k < count; ++k) sums[k] = all(Real{0});
    const Real* panel = t.panel + static_cast<long>(first) * front_tile<Real>;
    for (int r = 0; r < t.rest; r += front_tile<Real>) {
      PackOf<Real> known[front_packs<Real>];
      for (int q = 0; q < front_packs<Real>; ++q) known[q] = load(t.beside + r + q * width<Real>);
      for (int k = 0; k < count; ++k) {
        for (int q = 0; q < front_packs<Real>; ++q) {
          sums[k] = sums[k] + known[q] * load(panel + k * front_tile<Real> + q * width<Real>);
        }
      }
      panel += static_cast<long>(t.pivots) * front_tile<Real>;
    }
    for (int k = 0; k < count; ++k) {
      Real parts[width<Real>];
      store(parts, sums[k]);
      for (int lane = 0; lane < width<Real>; ++lane) t.values[first + k] -= parts[lane];
    }
  }
}

}  // namespace

void multiply_panel(const PanelTask<double>& task) { multiply(task); }
void multiply_panel(const PanelTask<float>& task) { multiply(task); }
void subtract_turned_panel(const PanelTask<double>& task) { subtract_turned(task); }
void subtract_turned_panel(const PanelTask<float>& task) { subtract_turned(task); }

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
