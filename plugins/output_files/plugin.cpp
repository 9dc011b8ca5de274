#include <stillpoint/sdk.hpp>

#include "output_files/frames_output.hpp"
#include "output_files/image_output.hpp"
#include "output_files/keyframes_output.hpp"
#include "output_files/summary_output.hpp"
#include "output_files/timings_output.hpp"
#include "output_files/trajectory_output.hpp"

using stillpoint::Output;
using stillpoint::provide;

STILLPOINT_PLUGIN(output_files, "0.1.0",
                  provide<Output, stillpoint::output_files::TrajectoryOutput>(
                      "trajectory", "trajectory.txt: poses of all tracked frames, TUM format"),
                  provide<Output, stillpoint::output_files::KeyFramesOutput>(
                      "keyframes", "keyframes.txt: poses of the key frames, TUM format"),
                  provide<Output, stillpoint::output_files::TimingsOutput>(
                      "timings", "timings.csv: time of every stage for every frame"),
                  provide<Output, stillpoint::output_files::FramesOutput>(
                      "frames", "frames.csv: state, features and excluded pixels of every frame"),
                  provide<Output, stillpoint::output_files::SummaryOutput>(
                      "summary", "summary.json: the figures of the run"),
                  provide<Output, stillpoint::output_files::ImageOutput>(
                      "images", "pictures of frames with features, moving points and labels"));
