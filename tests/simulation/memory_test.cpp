// Scenes that do not fit into memory: an error in words, where Embree would end the process or wait
// for ever.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iostream>
#include <new>
#include <string>

#include "simulation/out_of_memory.hpp"
#include "simulation/ray_caster.hpp"
#include "simulation/simulator.hpp"
#include "small_camera.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::simulation {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;
constexpr const char* kMessage = "there is not enough memory for this scene";

void limit_address_space(std::size_t more) {
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  file >> pages;
  const rlim_t bytes = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + more;
  const rlimit limit{.rlim_cur = bytes, .rlim_max = bytes};
  ::setrlimit(RLIMIT_AS, &limit);
}

/// Ends the process with the exit code of what `work` throws when it gets so many bytes more.
template <class Work>
[[noreturn]] void exit_with(std::size_t more, const Work& work) {
  ::alarm(60);  // seconds; who waits for ever is ended
  limit_address_space(more);
  int code = 0;
  try {
    work();
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    code = error.exit_code();
  }
  ::_exit(code);
}

Mesh one_box() {
  Mesh mesh;
  add_box(mesh, Eigen::Affine3f(Eigen::Translation3f(0, 0, 3)), {1, 1, 1}, {});
  return mesh;
}

class Memory : public ::testing::Test {
 protected:
  Memory() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }  // no threads of earlier tests
};

TEST_F(Memory, WithoutEnoughTheCasterSaysSoAndEnds) {
  const auto cast = [mesh = one_box()] { const RayCaster caster(mesh); };
  EXPECT_EXIT(exit_with(2 * kMiB, cast), ::testing::ExitedWithCode(1), kMessage);
  EXPECT_EXIT(exit_with(1024 * kMiB, cast), ::testing::ExitedWithCode(0), "");
}

TEST_F(Memory, WhateverThereIsTheCasterStartsOrSaysWhyNot) {
  const auto cast = [mesh = one_box()] {
    for (int i = 0; i < 2; ++i) {
      const RayCaster caster(mesh);
    }
  };
  const auto ends_in_order = [](int status) {
    return WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 1);
  };
  for (const std::size_t more : {20, 60, 100, 130, 145, 158, 162, 170, 190, 220, 260})
    EXPECT_EXIT(exit_with(more * kMiB, cast), ends_in_order, "") << more;
}

TEST_F(Memory, WithoutEnoughTheSimulatorSaysSo) {
  const auto simulate = [] {
    SceneOptions scene;
    scene.frames = 1;
    Simulator(scene, small_camera(), 1).frame(0);
  };
  EXPECT_EXIT(exit_with(8 * kMiB, simulate), ::testing::ExitedWithCode(1), kMessage);
  EXPECT_EXIT(exit_with(100 * kMiB, simulate), ::testing::ExitedWithCode(1), kMessage);
}

TEST_F(Memory, OtherFaultsStayWhatTheyAre) {
  const auto thrown_for = [](const auto& fault) {
    try {
      try {
        throw fault;
      } catch (...) {
        rethrow_named();
      }
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(thrown_for(Error(Fault::kUsage, "a fault")), "a fault");
  EXPECT_NE(thrown_for(std::bad_alloc()).find(kMessage), std::string::npos);
  EXPECT_THROW(thrown_for(1), int);
}

}  // namespace
}  // namespace stillpoint::simulation
