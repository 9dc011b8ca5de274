// Recordings in folders, trajectories, and those of other data sets.
#include <opencv2/core.hpp>

#include "evaluation/trajectory.hpp"
#include "fuzz/fuzz_target.hpp"
#include "importing/matrix_pose.hpp"
#include "importing/sens_file.hpp"
#include "importing/sens_writer.hpp"
#include "tum_recording/stamp_list.hpp"

namespace stillpoint::testing {
namespace {

using tum_recording::read_image_list;

FuzzTarget stamp_list() {
  return {.seeds = {bytes_of_text("# color images\n1305031102.175304 rgb/1305031102.175304.png\n"
                                  "1305031102.211214,\trgb/1305031102.211214.png\n")},
          .parse =
              [](const fs::path& file) {
                std::vector<std::string> warnings;
                read_image_list(file, warnings);
              },
          .words = {"nan", "inf", "1e308", "1e-400", "-", "\n", "\r\n", "#", ",", "\t",
                    std::string(1, '\0')}};
}

FuzzTarget trajectory() {
  return {.seeds = {bytes_of_text("# time tx ty tz qx qy qz qw\n1.5 0 1 2 0 0 0 1\n"
                                  "1.6 0.25 -1e-3 2.5 0.1 0.2 0.3 0.9\n"),
                    bytes_of_text("#timestamp, p_RS_R_x [m]\n"
                                  "1403636580838555648,1,2,3,1,0,0,0,0,0,0,0,0,0,0,0,0\n"
                                  "1403636580843555328,1,2,3,1,0,0,0,0,0,0,0,0,0,0,0,0\n"),
                    bytes_of_text("1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 4 1 0 0 5 0 0 1 6\n")},
          .parse =
              [](const fs::path& file) {
                const auto trajectory = evaluation::read_trajectory(file);
                evaluation::pose_at(trajectory, 1.55);
                evaluation::median_interval(trajectory);
              },
          .words = {"nan", "inf", "1e308", "1e-400", "-", "\n", "\r\n", "#", ",", "0 0 0 0"}};
}

FuzzTarget sens() {
  const auto file = [](std::int32_t color_kind, std::int32_t depth_kind) {
    SensWriter writer;
    writer.color_size = writer.depth_size = {9, 6};
    writer.color_kind = color_kind;
    writer.depth_kind = depth_kind;
    const cv::Mat color(6, 9, CV_8UC3, cv::Scalar(1, 2, 3)), depth(6, 9, CV_16UC1, cv::Scalar(900));
    writer.images = {{.color = color, .depth = depth, .time = 1},
                     {.color = color, .depth = depth, .time = 2, .world_from_camera = {}}};
    return writer.bytes();
  };
  return {.seeds = {file(1, 0), file(2, 1)}, .parse = [](const fs::path& path) {
            importing::SensFile recording(path, 4);
            for (std::size_t i = 0; i < recording.frames().size(); ++i) {
              recording.color(i);
              recording.depth(i);
            }
          }};
}

FuzzTarget matrix_pose() {
  return {.seeds = {bytes_of_text("1 0 0 0.5\n0 1 0 -2e-3\n0 0 1 3\n0 0 0 1\n")},
          .parse = [](const fs::path& file) { importing::read_matrix_pose(file); },
          .words = {"nan", "-inf", "-1.#IND", "1e400", "1e308", "\n", "\t", "+", "-"}};
}

}  // namespace

std::vector<NamedFuzzTarget> recording_targets() {
  return {{"StampList", stamp_list},
          {"Trajectory", trajectory},
          {"Sens", sens},
          {"MatrixPose", matrix_pose}};
}

}  // namespace stillpoint::testing
