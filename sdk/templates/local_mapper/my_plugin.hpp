// Local mapper `my_plugin`: landmarks from depth, which are removed when tracking does not find
// them again.
#pragma once

#include <stillpoint/sdk.hpp>
#include <vector>

namespace plugins::my_plugin {

class MyPlugin final : public stillpoint::LocalMapper {
 public:
  struct Options {
    double max_depth = 5.0;
    double min_found_share = 0.25;
    int probation = 3;

    void visit(stillpoint::OptionVisitor& v) {
      v("max_depth", max_depth,
        {.min = 0.1, .unit = "m", .help = "of new landmarks; farther ones are too noisy"});
      v("min_found_share", min_found_share,
        {.min = 0,
         .max = 1,
         .help = "of the frames that should see a landmark; it is removed when fewer do"});
      v("probation", probation,
        {.min = 1, .unit = "key frames", .help = "for which a new landmark is looked at"});
    }
  };

  explicit MyPlugin(Options options) : options_(options) {}

  stillpoint::SparseMap insert(stillpoint::SparseMap map, stillpoint::KeyFrame keyframe) override;
  stillpoint::SparseMap refine(stillpoint::SparseMap map, stillpoint::KeyFrameId keyframe,
                               std::stop_token end_early) override;

 private:
  void add_landmarks(stillpoint::MapEdit& edit, stillpoint::KeyFrameId id);

  Options options_;
  std::vector<stillpoint::LandmarkId> recent_;  // on probation
};

}  // namespace plugins::my_plugin
