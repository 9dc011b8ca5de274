#include "my_plugin.hpp"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <opencv2/core.hpp>

namespace plugins::my_plugin {
namespace {

/// Of pixels that are used for tracking; empty weights mean all of them.
double static_share(const stillpoint::FrameReport& report) {
  if (!report.weights || report.weights->track.empty()) return 1.0;
  const cv::Mat& weights = report.weights->track;
  return cv::countNonZero(weights) / static_cast<double>(weights.total());
}

}  // namespace

void MyPlugin::Options::visit(stillpoint::OptionVisitor& v) {
  v("file", file, {.help = "name in the run's folder"});
  v("every", every, {.min = 1, .unit = "frames", .help = "from one line to the next"});
  v.require(!file.empty() && std::filesystem::path(file).filename() == file,
            "file must be a name without folders");
}

MyPlugin::MyPlugin(const Options& options, const stillpoint::StageContext& context)
    : options_(options), file_(context.output_directory / options.file) {
  file_.stream() << "frame,time,state,x,y,z,inliers,moving_points,static_share\n"
                 << std::fixed << std::setprecision(6);
}

void MyPlugin::frame(const stillpoint::FrameReport& report) {
  if (report.frame->index % static_cast<std::uint32_t>(options_.every) != 0) return;
  const stillpoint::TrackResult& result = report.result;
  const auto moving = std::ranges::count_if(report.moving.points, &stillpoint::PointMotion::moving);
  file_.stream() << report.frame->index << ',' << report.frame->time << ','
                 << stillpoint::name_of(result.state);
  if (result.state == stillpoint::TrackState::kTracking) {
    const Eigen::Vector3d& position = result.world_from_camera.translation();
    file_.stream() << ',' << position.x() << ',' << position.y() << ',' << position.z();
  } else {
    file_.stream() << ",,,";
  }
  file_.stream() << ',' << result.inliers << ',' << moving << ',' << static_share(report) << '\n';
}

void MyPlugin::finish(const stillpoint::RunSummary&) { file_.commit(); }

}  // namespace plugins::my_plugin

// What the library provides: the type `my_plugin`.
STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::Output, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "one line of CSV per frame"));
