#include "problems/core/motion.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/sparse_factor.hpp"

namespace strongpoint {
namespace {

/// Rows for products that are taken many times: short indices.
using ProductMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

void check(const SparseFactor& factor, const char* what, const char* remedy) {
  if (factor.fault() == SparseFactor::Fault::none) return;
  const char* fault = factor.fault() == SparseFactor::Fault::singular ? "is singular"
                      : factor.fault() == SparseFactor::Fault::out_of_memory
                          ? "does not fit into memory"
                          : "cannot be factorised";
  throw CaseError(fmt::format("{} {}; {}", what, fault, remedy));
}

/// A matrix with its factors.
struct Factored {
  RowMatrix matrix;
  std::optional<SparseFactor> factor;

  void compute(const char* what, const char* remedy) {
    matrix.makeCompressed();
    factor.emplace(Eigen::Map<const RowMatrix>(matrix.rows(), matrix.cols(), matrix.nonZeros(),
                                               matrix.outerIndexPtr(), matrix.innerIndexPtr(),
                                               matrix.valuePtr()));
    check(*factor, what, remedy);
  }
  void solve(const double* b, double* x) const {
    factor->solve(b, x, SparseFactor::Refinement::none);
  }
};

/// Where each unknown of a system stands among those that move, or behind them.
struct Places {
  std::vector<int> of;  ///< (unknowns)
  int moving = 0;
};

/// The rows chosen of a system, row i times `factor(i)`, with the columns at their places.
template <class Matrix, class Factor>
Matrix rows_of(const LinearSystem& system, const std::vector<int>& rows, const Places& places,
               const Factor& factor) {
  Matrix result(static_cast<Eigen::Index>(rows.size()),
                static_cast<Eigen::Index>(places.of.size()));
  std::vector<int> entries(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    entries[i] = static_cast<int>(system.offsets[rows[i] + 1] - system.offsets[rows[i]]);
  }
  result.reserve(entries);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::int64_t e = system.offsets[rows[i]]; e < system.offsets[rows[i] + 1]; ++e) {
      result.insert(static_cast<Eigen::Index>(i), places.of[system.columns[e]]) =
          factor(rows[i]) * system.values[e];
    }
  }
  result.makeCompressed();
  return result;
}

}  // namespace

/// Unknowns that move come first, the rest behind them.
struct CondensedMotion::Blocks {
  Places places;
  std::vector<int> resting;         ///< the other unknowns, ascending
  ProductMatrix moving_rows;        ///< (size, all) M_d^-1 [A_II, A_IB], M_d the diagonal inertia
  ProductMatrix resting_by_moving;  ///< (rest, size) A_BI
  Factored resting_rows;            ///< A_BB
  Eigen::VectorXd resting_data;     ///< (rest) right-hand sides of the rows B
  RowMatrix values;                 ///< (size, all) V, empty where unknowns are values
  RowMatrix constraints;            ///< (rest, all) [A_BI, A_BB]
  Factored mass;                    ///< [V; constraints], where unknowns are no values
  mutable Eigen::VectorXd all, rest, right;  ///< room for products

  bool has_mass() const { return values.rows() > 0; }

  /// [top; constraints]
  RowMatrix bordered(const RowMatrix& top) const {
    RowMatrix matrix(top.rows() + constraints.rows(), top.cols());
    matrix.reserve(top.nonZeros() + constraints.nonZeros());
    for (const auto& [part, first] :
         {std::pair{&top, Eigen::Index{0}}, {&constraints, top.rows()}}) {
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

  /// Fills `all` with u and what the rows B say of the rest when their data are `data` times
  /// their size.
  void complete(const Eigen::VectorXd& u, double data) const {
    all.head(u.size()) = u;
    if (rest.size() == 0) return;
    rest.noalias() = -(resting_by_moving * u);
    if (data != 0) rest += data * resting_data;
    resting_rows.solve(rest.data(), all.data() + u.size());
  }

  /// M^-1 of accelerations times diagonal inertia.
  void divide_by_mass(Eigen::VectorXd& accelerations) const {
    if (!has_mass()) return;
    right.head(accelerations.size()) = accelerations;
    right.tail(rest.size()).setZero();
    mass.solve(right.data(), all.data());
    accelerations = all.head(accelerations.size());
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
  blocks.places.of.resize(count);
  blocks.places.moving = size();
  for (int i = 0; i < size(); ++i) blocks.places.of[moving_[i]] = i;
  for (std::size_t i = 0; i < blocks.resting.size(); ++i) {
    blocks.places.of[blocks.resting[i]] = size() + static_cast<int>(i);
  }
  const auto per_mass = [&](int row) { return 1 / (inertia[row] * system.row_scales[row]); };
  const auto as_is = [](int) { return 1.0; };
  blocks.moving_rows = rows_of<ProductMatrix>(system, moving_, blocks.places, per_mass);
  blocks.constraints = rows_of<RowMatrix>(system, blocks.resting, blocks.places, as_is);
  const auto rest = static_cast<Eigen::Index>(blocks.resting.size());
  blocks.resting_by_moving = blocks.constraints.leftCols(size());
  blocks.resting_rows.matrix = blocks.constraints.rightCols(rest);
  blocks.resting_data = system.right_hand_side(blocks.resting);
  blocks.all.setZero(count);
  blocks.rest.setZero(rest);
  blocks.right.setZero(count);
  if (rest > 0) {
    blocks.resting_rows.compute("the block of the boundary conditions",
                                "take stencils that hold the boundary nodes they belong to");
  }
  if (values != nullptr) {
    const auto by_scale = [&](int row) { return 1 / values->row_scales[row]; };
    blocks.values = rows_of<RowMatrix>(*values, moving_, blocks.places, by_scale);
    blocks.mass.matrix = blocks.bordered(blocks.values);
    blocks.mass.compute("the matrix of the nodal values", "take other stencils");
  }
  blocks.complete(Eigen::VectorXd::Zero(size()), 1);
  load_ = blocks.moving_rows * blocks.all;
  for (int i = 0; i < size(); ++i) {
    load_[i] -= system.right_hand_side[moving_[i]] * per_mass(moving_[i]);
  }
  blocks.divide_by_mass(load_);
}

CondensedMotion::~CondensedMotion() = default;

void CondensedMotion::apply(const Eigen::VectorXd& u, Eigen::VectorXd& product) const {
  blocks_->complete(u, 0);
  product.noalias() = blocks_->moving_rows * blocks_->all;
  blocks_->divide_by_mass(product);
}

Eigen::VectorXd CondensedMotion::all_unknowns(const Eigen::VectorXd& u, double load) const {
  blocks_->complete(u, load);
  Eigen::VectorXd unknowns(blocks_->all.size());
  for (Eigen::Index i = 0; i < unknowns.size(); ++i)
    unknowns[i] = blocks_->all[blocks_->places.of[i]];
  return unknowns;
}

Eigen::VectorXd CondensedMotion::from_values(const Eigen::VectorXd& values) const {
  Eigen::VectorXd u = values(moving_);
  blocks_->divide_by_mass(u);
  return u;
}

/// [V - factor A; A_BI, A_BB] [x; .] = [M b; 0], V being the identity where unknowns are values.
class CondensedMotion::Shifted final : public ShiftedMotion {
 public:
  Shifted(const Blocks& blocks, double factor) : blocks_(blocks) {
    RowMatrix top = (-factor * blocks.moving_rows).cast<double>();
    RowMatrix mass = blocks.values;
    if (!blocks.has_mass()) {
      mass.resize(top.rows(), top.cols());
      mass.setIdentity();
    }
    top += mass;
    factored_.matrix = blocks.bordered(top);
    factored_.compute("the matrix of the shifted motion", "take another time step");
  }
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const override {
    Eigen::VectorXd& right = blocks_.right;
    if (blocks_.has_mass()) {
      blocks_.complete(b, 0);
      right.head(b.size()).noalias() = blocks_.values * blocks_.all;
    } else {
      right.head(b.size()) = b;
    }
    right.tail(blocks_.rest.size()).setZero();
    factored_.solve(right.data(), blocks_.all.data());
    x = blocks_.all.head(b.size());
  }

 private:
  const Blocks& blocks_;
  Factored factored_;
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
