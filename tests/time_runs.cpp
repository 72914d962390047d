#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "methods/core/error.hpp"
#include "studies/support/case_monitor.hpp"
#include "studies/support/frames.hpp"
#include "studies/support/noise_run.hpp"

namespace strongpoint {
namespace {

/// u'' = lambda u in each of its unknowns.
class Diagonal final : public Motion {
 public:
  explicit Diagonal(std::vector<double> lambdas)
      : lambdas_(Eigen::Map<Eigen::VectorXd>(lambdas.data(), lambdas.size())),
        load_(Eigen::VectorXd::Zero(lambdas_.size())) {}
  int size() const override { return static_cast<int>(lambdas_.size()); }
  void apply(const Eigen::VectorXd& u, Eigen::VectorXd& product) const override {
    product = lambdas_.cwiseProduct(u);
  }
  const Eigen::VectorXd& load() const override { return load_; }
  std::unique_ptr<ShiftedMotion> shifted(double) const override { return nullptr; }

 private:
  Eigen::VectorXd lambdas_, load_;
};

Quantity growth(const std::vector<double>& lambdas, double end, double dt) {
  const Diagonal motion(lambdas);
  return noise_growth(DampedMotion(motion, {}, 1), steps_until(end, dt, "central"), {}, nullptr);
}

/// A file of the tests' own.
std::string scratch(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("strongpoint_time_runs_" + name)).string();
}

TEST(NoiseGrowth, IsThatOfTheFastestVibration) {
  // Central differences let exp(s t) grow by acosh(1 + (s dt)^2 / 2) / dt; the other half of cosh
  // has died out to e^-20 at T/4.
  const double dt = 0.01;
  for (const double s : {1.0, 2.0}) {
    const double expected = std::acosh(1 + s * s * dt * dt / 2) / dt;
    EXPECT_NEAR(growth({-4, s * s, 0.1}, 40, dt).value.value(), expected, 1e-8 * expected) << s;
  }
}

TEST(NoiseGrowth, HasAFigureBeyondTheLargestNumber) {
  const double s = 100;  // exp(4000) at the end
  const double dt = 0.001;
  const double expected = std::acosh(1 + s * s * dt * dt / 2) / dt;
  EXPECT_NEAR(growth({s * s}, 40, dt).value.value(), expected, 1e-8 * expected);
}

TEST(NoiseGrowth, IsNoneWhereVibrationsAreHarmonic) {
  // Both windows hold 8 periods of 2 pi / 8 and many of the other; steps are 1/100 of a period.
  EXPECT_NEAR(growth({-64, -6400}, 8 * std::acos(-1.0), 1e-3).value.value(), 0, 1e-4);
}

TEST(NoiseGrowth, TakesEightStepsAtLeast) {
  for (const double end : {0.7, 1e-9}) {
    EXPECT_FALSE(growth({-1}, end, 0.1).value);
    EXPECT_NE(growth({-1}, end, 0.1).reason.find("take --noise 0.8 "), std::string::npos);
  }
  EXPECT_TRUE(growth({-1}, 0.8, 0.1).value);
}

TEST(Steps, EndWhereTheRunEnds) {
  EXPECT_EQ(steps_until(3, 1e-4, "central").count, 30000);
  const Steps steps = steps_until(1, 0.3, "central");
  EXPECT_EQ(steps.count, 4);
  EXPECT_EQ(steps.dt, 0.25);
  EXPECT_EQ(steps_until(1, 7, "central").count, 1);
  EXPECT_EQ(steps_until(2.8, 7e-4, "central").time(4000), 2.8);
  EXPECT_THROW(steps_until(1, 1e-13, "central"), CaseError);
}

TEST(Frames, AreEquallySpacedUpToTheEnd) {
  const Steps steps = steps_until(1, 0.1, "central");
  const Frames three(scratch("case.vtu"), 3, steps);
  std::vector<std::int64_t> chosen;
  for (std::int64_t step = 0; step <= steps.count; ++step) {
    if (three.at(step) == 0) continue;
    chosen.push_back(step);
    EXPECT_EQ(three.at(step), static_cast<int>(chosen.size()));
  }
  EXPECT_EQ(chosen, (std::vector<std::int64_t>{3, 7, 10}));
  const Frames all(scratch("case.vtu"), 10, steps);
  for (int step = 1; step <= 10; ++step) EXPECT_EQ(all.at(step), step);
  EXPECT_THROW(Frames(scratch("case.vtu"), 11, steps), CaseError);
}

MotionState odd_state() {
  MotionState state;
  state.step = 123456789012;
  state.displacement = Eigen::Vector3d(0.1, -0.0, std::numeric_limits<double>::denorm_min());
  state.velocity = Eigen::Vector3d(1e300, 1 / 3.0, -7);
  state.acceleration = Eigen::Vector2d(2, std::nextafter(2.0, 3.0));
  return state;
}

bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0;
}

TEST(Checkpoint, GivesBackTheBits) {
  const Checkpoint checkpoint(scratch("bits"), "a run", "1.0");
  const MotionState saved = odd_state();
  double memory[2] = {0.3, -4};
  checkpoint.save(saved, std::as_bytes(std::span(memory)));
  MotionState state = odd_state();
  state.step = 0;
  for (Eigen::VectorXd* part : {&state.displacement, &state.velocity, &state.acceleration}) {
    part->setZero();
  }
  double found[2] = {0, 0};
  EXPECT_EQ(checkpoint.load(state, std::as_writable_bytes(std::span(found))),
            Checkpoint::Found::state);
  EXPECT_EQ(state.step, saved.step);
  EXPECT_TRUE(same_bits(state.displacement, saved.displacement));
  EXPECT_TRUE(same_bits(state.velocity, saved.velocity));
  EXPECT_TRUE(same_bits(state.acceleration, saved.acceleration));
  EXPECT_EQ(found[0], 0.3);
  EXPECT_EQ(found[1], -4);
  checkpoint.remove();
  EXPECT_EQ(checkpoint.load(state, {}), Checkpoint::Found::nothing);
}

TEST(Checkpoint, LeavesTheStateAloneUnlessItFits) {
  const std::string path = scratch("fits");
  const Checkpoint checkpoint(path, "a run", "1.0");
  checkpoint.save(odd_state(), {});
  MotionState state = odd_state();
  state.step = 7;
  EXPECT_EQ(Checkpoint(path, "a run", "1.1").load(state, {}), Checkpoint::Found::other_version);
  EXPECT_THROW(Checkpoint(path, "another run", "1.0").load(state, {}), CaseError);
  double memory = 0;
  EXPECT_THROW(checkpoint.load(state, std::as_writable_bytes(std::span(&memory, 1))), CaseError);
  state.velocity.setZero(4);
  EXPECT_THROW(checkpoint.load(state, {}), CaseError);
  EXPECT_EQ(state.step, 7);
  checkpoint.remove();
}

TEST(Checkpoint, NoticesEveryByteThatChangedAndEveryCut) {
  const std::string path = scratch("damaged");
  const Checkpoint checkpoint(path, "a run", "1.0");
  checkpoint.save(odd_state(), {});
  std::ifstream file(path, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  MotionState state = odd_state();
  const auto refuses = [&](const std::string& text) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
    try {
      checkpoint.load(state, {});
      return false;
    } catch (const CaseError& error) {
      return std::string(error.what()).find(path) != std::string::npos;
    }
  };
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string changed = whole;
    changed[i] ^= 4;
    EXPECT_TRUE(refuses(changed)) << "byte " << i;
    EXPECT_TRUE(refuses(whole.substr(0, i))) << "cut at " << i;
  }
  EXPECT_TRUE(refuses(whole + "x"));
  checkpoint.remove();
}

TEST(SaveRequest, IsServedOrGivenUp) {
  SaveRequest request;
  request.ask(std::chrono::hours(1));  // nobody serves: returns at once
  {
    SaveRequest::Server server(&request);
    std::thread asking([&] { request.ask(std::chrono::hours(1)); });
    while (!server.is_asked()) std::this_thread::yield();
    server.done();
    asking.join();
    EXPECT_FALSE(server.is_asked());
    request.ask(std::chrono::milliseconds(1));  // it does not serve: patience ends
    EXPECT_TRUE(server.is_asked());
  }
  request.ask(std::chrono::hours(1));  // gone: returns at once
}

}  // namespace
}  // namespace strongpoint
