#include "source_simulation/simulation_source.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace stillpoint::source_simulation {
namespace {

TEST(SimulationSource, GivesTheFramesOfTheSimulator) {
  SimulationSource::Options options;
  options.frames = 2;
  options.room.furnished = false;
  StageContext context;
  context.camera = CameraModel{.width = 64, .height = 48, .fx = 50, .fy = 50, .cx = 32, .cy = 24};
  SimulationSource source(options, context);
  simulation::Simulator simulator(options, *context.camera, 2);
  EXPECT_EQ(source.size(), 2U);
  for (std::uint32_t i = 0; i < 2; ++i) {
    const auto frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    const simulation::SimulatedFrame expected = simulator.frame(static_cast<int>(i));
    EXPECT_EQ(frame->time, expected.time);
    EXPECT_EQ(cv::norm(frame->bgr.reshape(1), expected.bgr.reshape(1), cv::NORM_INF), 0);
    EXPECT_EQ(frame->gray.type(), CV_8UC1);
    EXPECT_FLOAT_EQ(frame->depth.at<float>(40, 30),
                    static_cast<float>(expected.depth.at<std::uint16_t>(40, 30)) / 5000.0F);
    EXPECT_EQ(frame->camera->width, 64);
  }
  EXPECT_FALSE(source.next());
  EXPECT_FALSE(source.next());
}

}  // namespace
}  // namespace stillpoint::source_simulation
