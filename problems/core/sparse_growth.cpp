#include "problems/core/sparse_growth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include <Eigen/Eigenvalues>

#include "problems/core/random.hpp"

namespace strongpoint {
namespace {

using Complex = std::complex<double>;

/// x = T_m(1 + dt^2 K / 2) x by m central-difference steps from rest.
class Block {
 public:
  /// Steps of sqrt(2) over the highest frequency: vibrations near that one grow 1.4 times as fast
  /// in steps as in time, and no others may hide behind them.
  Block(const Motion& motion, double spectral_radius)
      : motion_(motion),
        dt_(std::sqrt(2 / spectral_radius)),
        before_(motion.size()),
        next_(motion.size()) {}

  double dt() const { return dt_; }
  std::int64_t products() const { return products_; }
  void advance(std::int64_t steps, Eigen::VectorXd& x) {
    motion_.apply(x, next_);
    before_ = x;
    x += dt_ * dt_ / 2 * next_;
    for (std::int64_t i = 1; i < steps; ++i) {
      motion_.apply(x, next_);
      before_ = 2 * x + dt_ * dt_ * next_ - before_;
      x.swap(before_);
    }
    products_ += steps;
  }
  /// K u, and its part along u.
  Complex quotient(const Eigen::VectorXcd& u, Eigen::VectorXcd& image) {
    before_ = u.real();
    motion_.apply(before_, next_);
    image.real() = next_;
    before_ = u.imag();
    motion_.apply(before_, next_);
    image.imag() = next_;
    products_ += 2;
    return u.dot(image) / u.squaredNorm();
  }

 private:
  const Motion& motion_;
  double dt_;
  Eigen::VectorXd before_, next_;
  std::int64_t products_ = 0;
};

/// A Krylov basis of blocks and what they do to it.
struct Krylov {
  Eigen::MatrixXd basis;  ///< (size, columns + 1), orthonormal
  Eigen::MatrixXd image;  ///< (columns, columns), upper Hessenberg
  double beyond = 0;      ///< norm of what lies outside in the image of the last column
};

/// Fills the basis from its first column.
Krylov krylov_of(Block& block, std::int64_t steps, const Eigen::VectorXd& start, int columns) {
  Krylov space{Eigen::MatrixXd(start.size(), columns + 1), Eigen::MatrixXd::Zero(columns, columns),
               0};
  space.basis.col(0) = start.normalized();
  Eigen::VectorXd x(start.size());
  for (int j = 0; j < columns; ++j) {
    x = space.basis.col(j);
    block.advance(steps, x);
    const auto sofar = space.basis.leftCols(j + 1);
    for (int pass = 0; pass < 2; ++pass) {  // twice is enough
      const Eigen::VectorXd along = sofar.transpose() * x;
      x.noalias() -= sofar * along;
      space.image.col(j).head(j + 1) += along;
    }
    const double norm = x.norm();
    if (!(norm > 1e-13 * space.image.col(j).norm())) {  // the space is invariant
      return {space.basis.leftCols(j + 2), space.image.topLeftCorner(j + 1, j + 1), 0};
    }
    (j + 1 < columns ? space.image(j + 1, j) : space.beyond) = norm;
    space.basis.col(j + 1) = x / norm;
  }
  return space;
}

/// The angle theta, mu = exp(i theta) being the growth per step, of mu + 1 / mu = 2 x; the one of
/// the two with |mu| >= 1.
Complex angle_of(Complex x) {
  const Complex theta = std::acos(x);
  return theta.imag() > 0 ? -theta : theta;
}

/// The angle of one step whose m-fold has the cosine y, its real part next to an estimate's of
/// either sign.
Complex unwrapped(Complex y, std::int64_t steps, Complex estimate) {
  const Complex whole = angle_of(y);
  const auto count = static_cast<double>(steps);
  Complex nearest;
  double distance = std::numeric_limits<double>::infinity();
  for (const double target : {estimate.real(), -estimate.real()}) {
    constexpr double turn = 2 * std::numbers::pi;
    const double turns = std::round((count * target - whole.real()) / turn);
    const Complex candidate = (whole + turns * turn) / count;
    if (std::abs(candidate.real() - target) < distance) {
      distance = std::abs(candidate.real() - target);
      nearest = candidate;
    }
  }
  return nearest;
}

/// Judges the Ritz vectors that claim to grow fastest.
class Search {
 public:
  Search(Block& block, Eigen::Index size) : block_(block), image_(size) {}

  const FoundGrowth& best() const { return best_; }
  /// Fastest growth of a vector that was not accurate enough, 1 over time.
  double claimed() const { return claimed_; }

  /// Takes the best pair of a space whose columns are `steps` steps apart, and gives the sum of the
  /// leading vectors to start from again.
  Eigen::VectorXd judge(const Krylov& space, std::int64_t steps) {
    const Eigen::EigenSolver<Eigen::MatrixXd> ritz(space.image);
    const Eigen::Index columns = space.image.cols();
    std::vector<Eigen::Index> order(columns);
    std::iota(order.begin(), order.end(), 0);
    Eigen::VectorXd claims(columns);
    const double time = static_cast<double>(steps) * block_.dt();
    for (Eigen::Index i = 0; i < columns; ++i) {
      claims[i] = -angle_of(ritz.eigenvalues()[i]).imag() / time;
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](Eigen::Index a, Eigen::Index b) { return claims[a] > claims[b]; });
    best_ = {};
    claimed_ = 0;
    Eigen::VectorXd start = Eigen::VectorXd::Zero(space.basis.rows());
    for (Eigen::Index k = 0; k < std::min(judged, columns); ++k) {
      const Eigen::Index i = order[k];
      const Complex y = ritz.eigenvalues()[i];
      if (y.imag() < 0) continue;  // its conjugate tells the same
      const Eigen::VectorXcd part = ritz.eigenvectors().col(i).normalized();
      const Eigen::VectorXcd u = space.basis.leftCols(columns) * part;
      start += u.real();
      const double error = space.beyond * std::abs(part[columns - 1]) / std::abs(y);
      claimed_ = std::max(claimed_, judge_pair(u, y, steps, error));
    }
    return start;
  }

 private:
  static constexpr Eigen::Index judged = 12;
  Block& block_;
  Eigen::VectorXcd image_;
  FoundGrowth best_;
  double claimed_ = 0;

  /// Takes a vector and its value y, of a relative error in blocks, if they tell a rate to some per
  /// cent; gives the rate they claim if they do not. The Rayleigh quotient says which of the
  /// frequencies with the same y is meant.
  double judge_pair(const Eigen::VectorXcd& u, Complex y, std::int64_t steps, double error) {
    const double dt = block_.dt();
    const Complex quotient = block_.quotient(u, image_);
    const Complex theta = unwrapped(y, steps, angle_of(1.0 + dt * dt / 2 * quotient));
    const Complex lambda = 2.0 * (std::cos(theta) - 1.0) / (dt * dt);
    image_ -= lambda * u;
    const double residual = image_.norm() / std::abs(lambda);
    const double time = static_cast<double>(steps) * dt;
    const Complex root = std::sqrt(lambda);
    constexpr double noise = 1e-6;  // round-off of 1e-13 in y where y is 1
    if (root.real() < noise / time) return 0;
    constexpr double share = 0.02;
    const bool known = residual * std::abs(root) / 2 < 1 / time;
    if (!known || !(error / time < share * root.real())) return root.real();
    if (root.real() > best_.rate) best_ = {root.real(), lambda, u, residual, 0, 0};
    return 0;
  }
};

}  // namespace

FoundGrowth find_growth(const Motion& motion, double spectral_radius, std::int64_t budget) {
  Block block(motion, spectral_radius);
  Search search(block, motion.size());
  Eigen::VectorXd start = random_vector(motion.size(), 1);
  // As many columns as there are vibrations that grow nearly as fast as the fastest; 64 MB of them.
  constexpr int most_columns = 320;
  constexpr int most_numbers = 8'000'000;
  const int columns =
      std::min({std::max(48, most_numbers / motion.size()), most_columns, motion.size()});
  double resolution = 0;
  for (std::int64_t steps = 8; columns * steps < budget - block.products(); steps *= 2) {
    const Krylov space = krylov_of(block, steps, start, columns);
    if (!space.image.allFinite()) break;
    start = search.judge(space, steps);
    resolution = std::log(1e3) / (static_cast<double>(columns * steps) * block.dt());
    const FoundGrowth& best = search.best();
    if (best.rate > 0 && search.claimed() <= 1.02 * best.rate) break;
  }
  FoundGrowth growth = search.best();
  growth.bound = std::max(search.claimed(), resolution);
  growth.products = block.products();
  return growth;
}

}  // namespace strongpoint
