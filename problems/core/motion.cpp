#include "problems/core/motion.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/moving_rows.hpp"
#include "problems/core/sparse_factor.hpp"

namespace strongpoint {
namespace {

/// Rows for products that are taken many times: short indices.
using ProductMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

void check(const SparseFactor& factor, const char* what, const char* remedy) {
  using Fault = SparseFactor::Fault;
  constexpr double least_ratio = 1e-15;  // pivots below are round-off of the largest
  const bool is_round_off = factor.pivot_ratio() < least_ratio;
  if (factor.fault() == Fault::none && !is_round_off) return;
  const char* fault = factor.fault() == Fault::out_of_memory ? "does not fit into memory"
                      : factor.fault() == Fault::other       ? "cannot be factorised"
                                                             : "is singular";
  throw CaseError(fmt::format("{} {}; {}", what, fault, remedy));
}

/// A matrix with its factors.
struct Factored {
  RowMatrix matrix;
  std::optional<TriangularFactors> factors;

  void compute(const char* what, const char* remedy) {
    matrix.makeCompressed();
    const SparseFactor factor(
        Eigen::Map<const RowMatrix>(matrix.rows(), matrix.cols(), matrix.nonZeros(),
                                    matrix.outerIndexPtr(), matrix.innerIndexPtr(),
                                    matrix.valuePtr()),
        SparseFactor::Ordering::least_fill);
    check(factor, what, remedy);
    factors.emplace(factor.packed());
  }
  void solve(const double* b, double* x) const { factors->solve(b, x); }
};

/// The rows chosen of a system, row i times `factor(i)`, with the columns at their places.
template <class Factor>
RowMatrix rows_of(const LinearSystem& system, const std::vector<int>& rows,
                  const std::vector<int>& places, const Factor& factor) {
  RowMatrix result(static_cast<Eigen::Index>(rows.size()),
                   static_cast<Eigen::Index>(places.size()));
  if (rows.empty()) return result;
  std::vector<int> entries(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    entries[i] = static_cast<int>(system.offsets[rows[i] + 1] - system.offsets[rows[i]]);
  }
  result.reserve(entries);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::int64_t e = system.offsets[rows[i]]; e < system.offsets[rows[i] + 1]; ++e) {
      result.insert(static_cast<Eigen::Index>(i), places[system.columns[e]]) =
          factor(rows[i]) * system.values[e];
    }
  }
  result.makeCompressed();
  return result;
}

/// Fields of every node that moves, 1 where some move in part.
int fields_that_move(const std::vector<int>& moving, int fields) {
  const auto count = static_cast<int>(moving.size());
  if (count % fields != 0) return 1;
  for (int i = 0; i < count; ++i) {
    const int first = moving[i - i % fields];
    if (first % fields != 0 || moving[i] != first + i % fields) return 1;
  }
  return fields;
}

/// [top; bottom]
RowMatrix stacked(const RowMatrix& top, const RowMatrix& bottom) {
  RowMatrix matrix(top.rows() + bottom.rows(), top.cols());
  matrix.reserve(top.nonZeros() + bottom.nonZeros());
  for (const auto& [part, first] : {std::pair{&top, Eigen::Index{0}}, {&bottom, top.rows()}}) {
    for (Eigen::Index row = 0; row < part->rows(); ++row) {
      matrix.startVec(first + row);
      for (RowMatrix::InnerIterator entry(*part, row); entry; ++entry) {
        matrix.insertBack(first + row, entry.col()) = entry.value();
      }
    }
  }
  matrix.finalize();
  return matrix;
}

}  // namespace

/// Unknowns that move come first, the rest behind them.
struct CondensedMotion::Blocks {
  std::vector<int> places;   ///< (unknowns) of each among those that move, or behind them
  std::vector<int> resting;  ///< the other unknowns, ascending
  std::optional<MovingRows> moving_rows;  ///< (size, all) [A_II, A_IB] over the inertia
  RowMatrix constraints;                  ///< (rest, all) [A_BI, A_BB]
  ProductMatrix resting_by_moving;        ///< (rest, size) -A_BI
  Factored resting_rows;                  ///< A_BB
  Eigen::VectorXd resting_data;           ///< (rest) right-hand sides of the rows B
  RowMatrix values;                       ///< (size, all) V, empty where unknowns are values
  Factored valued;                        ///< [V; constraints], where unknowns are no values
  mutable Eigen::VectorXd moving, rest, all, right;  ///< room for products

  bool has_values() const { return values.rows() > 0; }

  /// The unknowns that move when their nodes have the values u and the data of the rows B are
  /// `data` times their size; `rest` becomes the others.
  const Eigen::VectorXd& complete(const Eigen::VectorXd& u, double data) const {
    if (has_values()) {
      right.head(u.size()) = u;
      right.tail(rest.size()) = data * resting_data;
      valued.solve(right.data(), all.data());
      moving = all.head(u.size());
      rest = all.tail(rest.size());
      return moving;
    }
    if (rest.size() > 0) {
      right.noalias() = resting_by_moving * u;
      if (data != 0) right += data * resting_data;
      resting_rows.solve(right.data(), rest.data());
    }
    return u;
  }

  /// Room for products, with as much as the way to complete unknowns needs.
  void make_room(Eigen::Index size) {
    const auto others = static_cast<Eigen::Index>(resting.size());
    rest.setZero(others);
    moving.setZero(has_values() ? size : 0);
    all.setZero(has_values() ? size + others : 0);
    right.setZero(has_values() ? size + others : others);
  }
};

CondensedMotion::CondensedMotion(const LinearSystem& system, const std::vector<double>& inertia,
                                 const LinearSystem* values)
    : blocks_(std::make_unique<Blocks>()) {
  if (system.rows() != system.unknowns()) {
    throw SkipCase(
        "waves need as many equations as unknowns; take a form that is not solved by "
        "least squares");
  }
  Blocks& blocks = *blocks_;
  const auto count = static_cast<int>(system.rows());
  for (int i = 0; i < count; ++i) (inertia[i] != 0 ? moving_ : blocks.resting).push_back(i);
  if (moving_.empty()) {
    throw CaseError("no equation has inertia: every node lies on the boundary; raise the level");
  }
  blocks.places.resize(count);
  for (int i = 0; i < size(); ++i) blocks.places[moving_[i]] = i;
  for (std::size_t i = 0; i < blocks.resting.size(); ++i) {
    blocks.places[blocks.resting[i]] = size() + static_cast<int>(i);
  }
  const auto per_mass = [&](int row) { return 1 / (inertia[row] * system.row_scales[row]); };
  const auto as_is = [](int) { return 1.0; };
  blocks.moving_rows.emplace(rows_of(system, moving_, blocks.places, per_mass),
                             fields_that_move(moving_, system.fields));
  blocks.constraints = rows_of(system, blocks.resting, blocks.places, as_is);
  blocks.resting_data = system.right_hand_side(blocks.resting);
  if (values != nullptr) {
    const auto by_scale = [&](int row) { return 1 / values->row_scales[row]; };
    blocks.values = rows_of(*values, moving_, blocks.places, by_scale);
    blocks.valued.matrix = stacked(blocks.values, blocks.constraints);
    blocks.valued.compute("the matrix of nodal values and boundary conditions",
                          "take other stencils");
  } else if (!blocks.resting.empty()) {
    blocks.resting_by_moving = -blocks.constraints.leftCols(size());
    blocks.resting_rows.matrix =
        blocks.constraints.rightCols(static_cast<Eigen::Index>(blocks.resting.size()));
    blocks.resting_rows.compute("the block of the boundary conditions",
                                "take stencils that hold the boundary nodes they belong to");
  }
  blocks.make_room(size());
  load_.resize(size());
  blocks.moving_rows->multiply(blocks.complete(Eigen::VectorXd::Zero(size()), 1), blocks.rest,
                               load_);
  for (int i = 0; i < size(); ++i) {
    load_[i] -= system.right_hand_side[moving_[i]] * per_mass(moving_[i]);
  }
}

CondensedMotion::~CondensedMotion() = default;

void CondensedMotion::apply(const Eigen::VectorXd& u, Eigen::VectorXd& product) const {
  const Eigen::VectorXd& moving = blocks_->complete(u, 0);
  blocks_->moving_rows->multiply(moving, blocks_->rest, product);
}

Eigen::VectorXd CondensedMotion::all_unknowns(const Eigen::VectorXd& u, double load) const {
  const Eigen::VectorXd& moving = blocks_->complete(u, load);
  const std::vector<int>& place = blocks_->places;
  Eigen::VectorXd unknowns(static_cast<Eigen::Index>(place.size()));
  for (Eigen::Index i = 0; i < unknowns.size(); ++i) {
    unknowns[i] = place[i] < size() ? moving[place[i]] : blocks_->rest[place[i] - size()];
  }
  return unknowns;
}

/// [V - factor A; C] x = [b; 0], V being the identity where unknowns are values, and V x.
class CondensedMotion::Shifted final : public ShiftedMotion {
 public:
  Shifted(const Blocks& blocks, double factor) : blocks_(blocks) {
    RowMatrix top = blocks.moving_rows->scaled(-factor);
    RowMatrix values = blocks.values;
    if (!blocks.has_values()) {
      values.resize(top.rows(), top.cols());
      values.reserve(top.rows());
      for (Eigen::Index row = 0; row < top.rows(); ++row) {
        values.startVec(row);
        values.insertBack(row, row) = 1;
      }
      values.finalize();
    }
    top += values;
    factored_.matrix = stacked(top, blocks.constraints);
    factored_.compute("the matrix of the shifted motion", "take another time step");
    right_.setZero(top.cols());
    all_.setZero(top.cols());
  }
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const override {
    right_.head(b.size()) = b;
    factored_.solve(right_.data(), all_.data());
    if (blocks_.has_values()) {
      x.noalias() = blocks_.values * all_;
    } else {
      x = all_.head(b.size());
    }
  }

 private:
  const Blocks& blocks_;
  Factored factored_;
  mutable Eigen::VectorXd right_, all_;
};

std::unique_ptr<ShiftedMotion> CondensedMotion::shifted(double factor) const {
  return std::make_unique<Shifted>(*blocks_, factor);
}

Eigen::MatrixXd dense_operator(const Motion& motion) {
  Eigen::MatrixXd matrix(motion.size(), motion.size());
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(motion.size());
  Eigen::VectorXd column(motion.size());
  for (int j = 0; j < motion.size(); ++j) {
    unit[j] = 1;
    motion.apply(unit, column);
    matrix.col(j) = column;
    unit[j] = 0;
  }
  return matrix;
}

}  // namespace strongpoint
