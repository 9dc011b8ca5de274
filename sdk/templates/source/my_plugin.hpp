// Source `my_plugin`: a wall with texture, rendered while it runs, along which the camera moves.
#pragma once

#include <memory>
#include <stillpoint/sdk.hpp>

namespace plugins::my_plugin {

class MyPlugin final : public stillpoint::Source {
 public:
  struct Options {
    int frames = 120;
    double distance = 2.0;
    double speed = 0.3;

    void visit(stillpoint::OptionVisitor& v) {
      v("frames", frames, {.min = 1, .help = "length of the recording, 30 frames per second"});
      v("distance", distance, {.min = 0.3, .max = 10, .unit = "m", .help = "of the wall"});
      v("speed", speed,
        {.min = -2, .max = 2, .unit = "m/s", .help = "of the camera, to the right"});
    }
  };

  MyPlugin(const Options& options, const stillpoint::StageContext& context);

  std::optional<stillpoint::Frame> next() override;
  std::optional<std::size_t> size() const override;

 private:
  Options options_;
  std::shared_ptr<const stillpoint::Camera> camera_;
  cv::Mat texture_;  // of one square metre, repeated
  std::uint32_t next_ = 0;
};

}  // namespace plugins::my_plugin
