// Decision `vote`: moving points and the map check vote on each object; votes are filtered over
// time.
#pragma once

#include <array>
#include <map>
#include <stillpoint/sdk.hpp>
#include <string>

#include "motion_filter.hpp"

/// What is known of a class before anybody votes.
struct ClassRule {
  enum class Map { kNever, kWhenStatic };
  double prior = 0.0;  ///< 0 stands still … 1 moves
  Map map = Map::kWhenStatic;

  void visit(stillpoint::OptionVisitor& v);
};

class VoteDecision final : public stillpoint::Decision {
 public:
  struct Options {
    std::map<std::string, ClassRule> classes = {
        {"person", {.prior = 0.8, .map = ClassRule::Map::kNever}}};
    int min_points = 4;          ///< on an object, for a vote
    double moving_share = 0.3;   ///< of the points on an object
    double sure_log_odds = 3.0;  ///< of the map check
    int reach = 8;               ///< px, around moving points that lie on no object
    int margin = 5;              ///< px, around objects that move
    FilterOptions filter;

    void visit(stillpoint::OptionVisitor& v);
  };

  /// Throws Error(kUsage) for a class that the segmenter does not have.
  VoteDecision(const Options& options, const stillpoint::StageContext& context);

  stillpoint::StaticWeights decide(const stillpoint::Frame& frame,
                                   const stillpoint::Segmentation& segmentation,
                                   const stillpoint::MovingPoints& moving,
                                   const stillpoint::MapEvidence& evidence) override;

 private:
  Vote vote_of_points(const cv::Mat& mask, const stillpoint::MovingPoints& moving) const;
  Vote vote_of_map(const cv::Mat& mask, const cv::Mat& log_odds) const;
  cv::Mat unlabelled_weights(const stillpoint::MovingPoints& moving, const cv::Mat& log_odds) const;

  Options options_;
  std::array<ClassRule, 256> rules_;  // by class id
  MotionFilter filter_;
};
