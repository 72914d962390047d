#include <dmumps_c.h>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/node_ordering.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {
namespace {

/// MUMPS' own word for the communicator of the sequential library.
constexpr int sequential = -987654;

/// An instance of MUMPS for one matrix, quiet; freed on every path.
class MumpsSession {
 public:
  MumpsSession(const LinearSystem& system, std::vector<int>& order) : system_(system) {
    const std::size_t entries = system.values.size();
    rows_.resize(entries);
    columns_.resize(entries);
    for (std::int64_t row = 0; row < system.rows(); ++row) {
      for (std::int64_t i = system.offsets[row]; i < system.offsets[row + 1]; ++i) {
        rows_[i] = static_cast<int>(row) + 1;
        columns_[i] = static_cast<int>(system.columns[i]) + 1;
      }
    }
    state_.par = 1;
    state_.sym = 0;
    state_.comm_fortran = sequential;
    call(Job::start);
    for (const int stream : {1, 2, 3}) control(stream) = -1;
    control(4) = 0;
    state_.n = static_cast<int>(system.rows());
    state_.nnz = static_cast<MUMPS_INT8>(entries);
    state_.irn = rows_.data();
    state_.jcn = columns_.data();
    state_.a = const_cast<double*>(system.values.data());  // it only reads
    constexpr int given = 1;
    constexpr int metis = 5;
    control(7) = order.empty() ? metis : given;
    if (!order.empty()) state_.perm_in = order.data();
  }
  MumpsSession(const MumpsSession&) = delete;
  MumpsSession& operator=(const MumpsSession&) = delete;
  ~MumpsSession() {
    state_.job = static_cast<int>(Job::end);
    dmumps_c(&state_);
  }

  enum class Job { start = -1, end = -2, analyse_factorise_solve = 6 };
  void call(Job job) {
    state_.job = static_cast<int>(job);
    dmumps_c(&state_);
  }
  /// Solves in place.
  void solve(Eigen::VectorXd& right_hand_side) {
    // The estimate of the memory fails where pivots are delayed: more room until it suffices.
    constexpr int most_room = 1000;
    constexpr int too_little_room = -9;
    constexpr int too_little_integer_room = -8;
    state_.rhs = right_hand_side.data();
    for (int room = 30; room <= most_room; room *= 2) {
      control(14) = room;
      call(Job::analyse_factorise_solve);
      if (state_.infog[0] != too_little_room && state_.infog[0] != too_little_integer_room) break;
    }
    check();
  }
  /// Most memory that the factorisation took.
  std::size_t bytes() const {
    constexpr int megabytes_place = 20;  // INFOG(21)
    return static_cast<std::size_t>(state_.infog[megabytes_place]) * 1'000'000;
  }

 private:
  const LinearSystem& system_;
  std::vector<int> rows_, columns_;
  DMUMPS_STRUC_C state_{};

  /// ICNTL(place) of the manual.
  MUMPS_INT& control(int place) { return state_.icntl[place - 1]; }

  void check() const {
    constexpr int structurally_singular = -6;
    constexpr int singular = -10;
    constexpr int no_memory = -13;
    const int status = state_.infog[0];
    if (status >= 0) return;
    if (status == singular || status == structurally_singular) throw_singular(system_, "mumps");
    if (status == no_memory) throw_out_of_memory(system_, "mumps");
    throw CaseError(
        fmt::format("mumps: failed with INFOG(1) = {}, INFOG(2) = {}; take umfpack or bicgstab",
                    status, state_.infog[1]));
  }
};

/// The place of each unknown, from 1, in the order of its nodes; empty when there is none.
std::vector<int> places_of(const LinearSystem& system) {
  const std::vector<std::int64_t> order = node_ordering(view_of(system), system.fields);
  std::vector<int> places(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) places[order[i]] = static_cast<int>(i) + 1;
  return places;
}

LinearSolution solve_mumps(const LinearSystem& system) {
  if (system.rows() > std::numeric_limits<int>::max()) {
    throw CaseError(
        fmt::format("mumps: {} unknowns exceed its 32-bit numbers; take bicgstab", system.rows()));
  }
  std::vector<int> places = places_of(system);
  MumpsSession session(system, places);
  LinearSolution solution;
  solution.x = system.right_hand_side;
  session.solve(solution.x);
  solution.bytes = session.bytes();
  return solution;
}

}  // namespace

/// Direct factorisation by sequential MUMPS, nested dissection of the nodes by METIS. Source:
/// Amestoy, Duff, Koster, L'Excellent 2001.
SolverEntry solver_mumps() {
  return {{"mumps", "sequential MUMPS with METIS on the nodes", {}},
          Shape::square,
          Approach::direct,
          [](const Options&) -> Solver { return solve_mumps; }};
}

}  // namespace strongpoint
