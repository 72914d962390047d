#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "problems/core/layout.hpp"

namespace strongpoint {

/// Round-off of a mesh file's 16 digits and a few operations.
constexpr double round_off = 1e-12;

/// A directory of its own for each test, removed afterwards.
class FileTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    directory_ = std::filesystem::temp_directory_path() /
                 fmt::format("strongpoint_{}_{}", test->name(), ::getpid());
    std::filesystem::create_directories(directory_);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }

 private:
  std::filesystem::path directory_;
};

/// The cloud of a file, nodes as they are numbered there.
template <int Dim>
PointCloud<Dim> load(const Domain<Dim>& domain, const std::string& file) {
  const PointCloud<Dim> cloud = make_cloud<Dim>(domain, "file[path=" + file + "]", {5, 1});
  std::vector<int> order(cloud.size());
  for (int i = 0; i < cloud.size(); ++i) order[cloud.number_of(i)] = i;
  return reordered(cloud, order);
}

/// Loads a file that must be refused; gives the message after the path it must begin with.
template <int Dim>
std::string refusal(const std::string& file) {
  try {
    load<Dim>(UnitCube<Dim>(), file);
  } catch (const CaseError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with(file + ": ")) << message;
    return message.substr(std::min(message.size(), file.size() + 2));
  }
  return "nothing was thrown";
}

/// Expects a text to hold a part; a macro keeps the number of the failing line.
#define STRONGPOINT_EXPECT_IN(part, text) EXPECT_NE((text).find(part), std::string::npos) << (text)

}  // namespace strongpoint
