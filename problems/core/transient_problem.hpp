#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problems/core/problem.hpp"

namespace strongpoint {

/// Waves: inertia u'' = what the equations of `space` leave over, in the rows whose equations have
/// inertia; all data of `space` are multiplied by one function of time.
template <int Dim>
class TransientProblem : public Problem<Dim> {
 public:
  /// The equations in space. Its `quantities` and `measure` are not used.
  virtual const SteadyProblem<Dim>& space() const = 0;
  const Domain<Dim>& domain() const override { return space().domain(); }
  /// Factor of all data at a time.
  virtual double load(double time) const = 0;
  /// Speed of the fastest wave, length over time.
  virtual double wave_speed() const = 0;
  /// Displacements at time 0, (fields).
  virtual Eigen::VectorXd initial_displacement(const Point<Dim>&) const { return at_rest(); }
  /// Velocities at time 0, (fields).
  virtual Eigen::VectorXd initial_velocity(const Point<Dim>&) const { return at_rest(); }
  /// When the solution is judged, unless a user says so.
  virtual double end_time() const = 0;
  /// Time step unless a user gives one.
  virtual double time_step() const = 0;
  /// Names of what `measure` gives.
  virtual std::vector<std::string> quantities() const = 0;
  /// Judges a solution at a time; one number per quantity, dimensionless unless the name says
  /// otherwise.
  virtual std::vector<double> measure(const Solution<Dim>& solution, double time) const = 0;
  /// What is worth looking at beside the fields, node by node. Asked for only when it is written.
  virtual std::vector<NodeArray> derived_fields(const Solution<Dim>& solution, double) const {
    return space().derived_fields(solution);
  }

 private:
  Eigen::VectorXd at_rest() const {
    return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space().fields().size()));
  }
};

/// Waves whose modes of vibration are known, when nothing is loaded.
template <int Dim>
class EigenProblem : public TransientProblem<Dim> {
 public:
  /// Circular frequency of mode n = 1, 2, ..., ascending, 1 over time.
  virtual double frequency(int n) const = 0;
  /// The mode's displacements, (fields), of any size.
  virtual Eigen::VectorXd mode(int n, const Point<Dim>& x) const = 0;
};

}  // namespace strongpoint
