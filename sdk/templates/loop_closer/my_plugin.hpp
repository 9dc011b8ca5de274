// Loop closer `my_plugin`: the newest key frame against an old one nearby; the drift between them
// is distributed linearly.
#pragma once

#include <stillpoint/sdk.hpp>

namespace plugins::my_plugin {

class MyPlugin final : public stillpoint::LoopCloser {
 public:
  struct Options {
    int min_gap = 10;
    double radius = 1.0;
    double max_angle = 30.0;
    int min_inliers = 40;
    double min_drift = 0.02;

    void visit(stillpoint::OptionVisitor& v);
  };

  MyPlugin(Options options, const stillpoint::StageContext& context)
      : options_(options), seed_(context.seed) {}

  std::optional<stillpoint::MapCorrection> close(const stillpoint::SparseMap& map,
                                                 stillpoint::KeyFrameId latest,
                                                 std::stop_token stop) override;

 private:
  const stillpoint::KeyFrame* candidate(const stillpoint::SparseMap& map,
                                        const stillpoint::KeyFrame& latest) const;
  std::optional<stillpoint::Pose> old_from_latest(const stillpoint::KeyFrame& old,
                                                  const stillpoint::KeyFrame& latest) const;

  Options options_;
  std::uint64_t seed_;
};

}  // namespace plugins::my_plugin
