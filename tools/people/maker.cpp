#include "people/maker.hpp"

#include <unistd.h>

#include <algorithm>

#include "people/depth_sensor.hpp"
#include "simulation/parallel.hpp"
#include "simulation/recording_writer.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::people {
namespace {

namespace fs = std::filesystem;

class Maker {
 public:
  Maker(const RecordingPlan& plan, const BaseRecording& base, const Sources& sources)
      : plan_(plan), base_(base), cast_(plan, base, sources) {}

  simulation::SimulatedFrame frame(const BasePair& pair, int index) const {
    simulation::SimulatedFrame frame{
        .index = index, .time = pair.time, .depth_time = pair.depth_time};
    const cv::Mat depth = base_.depth(pair);
    const cv::Mat scene = filled_depth(depth);
    frame.bgr = base_.color(pair);
    const std::vector<Layer> layers = cast_.seen_at(pair.time);
    const Composition composition = compose(layers, scene);
    paint(layers, composition, frame.bgr);
    frame.instances = base_.rays().rectified(composition.owner);
    frame.labels = base_.labels(pair);
    frame.labels.setTo(0, frame.instances > 0);
    const auto people = static_cast<double>(cast_.people());
    frame.labels.setTo(simulation::kPerson, (frame.instances > 0) & (frame.instances <= people));
    frame.depth = measured(pair, scene, depth, index);
    return frame;
  }

 private:
  /// The depth image has a time of its own, and so have the people in it.
  cv::Mat measured(const BasePair& pair, const cv::Mat& scene, cv::Mat depth, int index) const {
    const Composition then = compose(cast_.shapes_at(pair.depth_time), scene);
    measure(then.z, static_cast<std::uint32_t>(plan_.seed), static_cast<std::uint32_t>(index),
            depth);
    depth.convertTo(depth, CV_16U, base_.camera().depth_factor);
    return depth;
  }

  const RecordingPlan& plan_;
  const BaseRecording& base_;
  Cast cast_;
};

/// Not those of the room: of people only.
double share_of_people(const cv::Mat& labels) {
  return static_cast<double>(cv::countNonZero(labels == simulation::kPerson)) /
         static_cast<double>(labels.total());
}

}  // namespace

Coverage make_recording(const RecordingPlan& plan, const BaseRecording& base,
                        const Sources& sources, const fs::path& out, int threads) {
  const fs::path part = out.string() + '.' + std::to_string(::getpid()) + ".part";
  fs::remove_all(part);
  const Maker maker(plan, base, sources);
  const std::vector<BasePair> pairs = pairs_of(plan, base);
  Coverage coverage{.frames = static_cast<int>(pairs.size())};
  {
    simulation::RecordingWriter writer(part);
    std::vector<double> shares(pairs.size());
    simulation::parallel_for(threads, coverage.frames, [&](int i) {
      const auto index = static_cast<std::size_t>(i);
      const simulation::SimulatedFrame frame = maker.frame(pairs[index], i);
      writer.write(frame);
      shares[index] = share_of_people(frame.labels);
    });
    for (const double share : shares) {
      coverage.mean += share / coverage.frames;
      coverage.max = std::max(coverage.max, share);
    }
  }
  fs::copy_file(base.ground_truth(), part / "groundtruth.txt");
  fs::rename(part, out);
  return coverage;
}

}  // namespace stillpoint::people
