#include "vote_decision.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

using stillpoint::MovingPoints;
using stillpoint::PointMotion;

namespace {

/// The map check's log-odds per pixel; 0 without any.
cv::Mat per_pixel(const stillpoint::MapEvidence& evidence, cv::Size size) {
  if (evidence.log_odds.empty()) return cv::Mat::zeros(size, CV_32F);
  cv::Mat log_odds;
  cv::resize(evidence.log_odds, log_odds, size, 0, 0, cv::INTER_NEAREST);
  return log_odds;
}

bool is_on(const cv::Mat& mask, const PointMotion& point) {
  const cv::Point pixel(point.current);
  return cv::Rect({}, mask.size()).contains(pixel) && mask.at<std::uint8_t>(pixel) != 0;
}

/// The mean of those who do not abstain.
Vote mean(Vote a, Vote b) {
  if (a && b) return (*a + *b) / 2;
  return a ? a : b;
}

cv::Mat grown(const cv::Mat& mask, int margin) {
  cv::Mat result;
  cv::dilate(mask, result, cv::Mat::ones(2 * margin + 1, 2 * margin + 1, CV_8U));
  return result;
}

/// Weights under the mask are at most `weight` from now on.
void lower(cv::Mat& weights, const cv::Mat& mask, double weight) {
  weights.setTo(weight, mask & (weights > weight));
}

}  // namespace

void ClassRule::visit(stillpoint::OptionVisitor& v) {
  v("prior", prior,
    {.min = 0, .max = 1, .help = "vote while nothing is known: 0 stands still … 1 moves"});
  v.choice("map", map, {{"never", Map::kNever}, {"when_static", Map::kWhenStatic}},
           {.help = "whether it may be mapped"});
}

void VoteDecision::Options::visit(stillpoint::OptionVisitor& v) {
  v("classes", classes, {.help = "rules by class name; other classes have prior 0 and are mapped"});
  v("min_points", min_points, {.min = 1, .help = "on an object, or the points abstain"});
  v("moving_share", moving_share,
    {.min = 0.01, .max = 1, .help = "of the points on an object that is a full vote for moving"});
  v("sure_log_odds", sure_log_odds,
    {.min = 0.1, .unit = "log-odds", .help = "of the map check, that are a full vote"});
  v("reach", reach,
    {.min = 0, .max = 100, .unit = "px", .help = "around moving points without a label, not used"});
  v("margin", margin,
    {.min = 0, .max = 50, .unit = "px", .help = "around moving objects, not used"});
  v("filter", filter, {.help = "of votes, over time"});
}

VoteDecision::VoteDecision(const Options& options, const stillpoint::StageContext& context)
    : options_(options), filter_(options.filter) {
  if (context.classes.empty()) return;  // no segmenter
  for (const auto& [name, rule] : options_.classes)
    rules_.at(static_cast<std::size_t>(stillpoint::class_id(context.classes, name))) = rule;
}

stillpoint::StaticWeights VoteDecision::decide(const stillpoint::Frame& frame,
                                               const stillpoint::Segmentation& segmentation,
                                               const MovingPoints& moving,
                                               const stillpoint::MapEvidence& evidence) {
  const cv::Mat log_odds = per_pixel(evidence, frame.gray.size());
  stillpoint::StaticWeights weights;
  weights.track = unlabelled_weights(moving, log_odds);
  weights.map = weights.track.clone();
  if (segmentation.instances.empty()) return weights;
  for (std::size_t i = 0; i < segmentation.objects.size(); ++i) {
    const stillpoint::SegmentedObject& object = segmentation.objects[i];
    const ClassRule& rule = rules_.at(static_cast<std::size_t>(object.label));
    cv::Mat mask = segmentation.instances == static_cast<double>(i + 1);
    const Vote vote = mean(vote_of_points(mask, moving), vote_of_map(mask, log_odds));
    const ObjectState& state = filter_.update(object, frame.time, rule.prior, vote);
    if (state.moves) mask = grown(mask, options_.margin);
    const double weight = state.moves ? 0 : 255 * (1 - state.vote);
    lower(weights.track, mask, weight);
    lower(weights.map, mask, rule.map == ClassRule::Map::kNever ? 0 : weight);
    weights.object_moves.push_back(state.moves);
  }
  filter_.forget(frame.time);
  return weights;
}

/// Limbs and folds move differently: a part of the points that moves is enough.
Vote VoteDecision::vote_of_points(const cv::Mat& mask, const MovingPoints& moving) const {
  if (!moving.reliable) return {};
  int points = 0, moved = 0;
  for (const PointMotion& point : moving.points) {
    if (!is_on(mask, point)) continue;
    ++points;
    moved += point.moving ? 1 : 0;
  }
  if (points < options_.min_points) return {};
  return std::min(1.0, moved / (points * options_.moving_share));
}

Vote VoteDecision::vote_of_map(const cv::Mat& mask, const cv::Mat& log_odds) const {
  const cv::Mat known = mask & (log_odds != 0);
  if (cv::countNonZero(known) == 0) return {};
  const double mean = cv::mean(log_odds, known)[0];
  return std::clamp(0.5 + 0.5 * mean / options_.sure_log_odds, 0.0, 1.0);
}

/// What moves need not have a label.
cv::Mat VoteDecision::unlabelled_weights(const MovingPoints& moving,
                                         const cv::Mat& log_odds) const {
  cv::Mat weights(log_odds.size(), CV_8UC1, cv::Scalar(255));
  weights.setTo(0, log_odds >= options_.sure_log_odds);
  if (!moving.reliable) return weights;
  for (const PointMotion& point : moving.points)
    if (point.moving) cv::circle(weights, point.current, options_.reach, cv::Scalar(0), cv::FILLED);
  return weights;
}

STILLPOINT_PLUGIN(vote_decision, "0.1.0",
                  stillpoint::provide<stillpoint::Decision, VoteDecision>(
                      "vote", "moving points and map evidence vote on objects, over time"));
