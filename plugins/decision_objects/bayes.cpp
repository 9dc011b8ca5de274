#include "decision_objects/bayes.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "decision_objects/class_selection.hpp"
#include "decision_objects/probability.hpp"
#include "decision_objects/weight_image.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint::decision_objects {
namespace {

constexpr double kUnlikelyLogOdds = -2;  // of moving, below which the weight is surely full
// Not 0: without any trust in labels, a person in front of the camera would be tracked at once.
constexpr double kMinLabelWeight = 0.05;
// Share of `contradiction` that it takes to map a surface even where labels are not trusted: two
// views that mapped it, more than eight that only tracked it. Those who sit still before the camera
// are tracked before long, and would be mapped.
constexpr double kLeastContradiction = 0.6;

std::vector<PointCount> count_points(const Segmentation& segmentation, const MovingPoints& moving) {
  std::vector<PointCount> counts(segmentation.objects.size());
  const cv::Mat& instances = segmentation.instances;
  for (const PointMotion& point : moving.points) {
    const cv::Point pixel = point.current;
    if (!cv::Rect({0, 0}, instances.size()).contains(pixel)) continue;
    const std::uint8_t instance = instances.at<std::uint8_t>(pixel);
    if (instance == 0) continue;
    PointCount& count = counts[instance - 1U];
    ++count.points;
    count.moving += point.moving ? 1 : 0;
  }
  return counts;
}

/// The map evidence, resampled to the cells of a motion field; 0 without any.
cv::Mat on_cells(const MapEvidence& evidence, cv::Size cells) {
  if (evidence.log_odds.empty()) return cv::Mat::zeros(cells, CV_32F);
  cv::Mat resized;
  cv::resize(evidence.log_odds, resized, cells, 0, 0, cv::INTER_NEAREST);
  return resized;
}

/// Mask of the pixels with map evidence below a limit; single cells are removed as noise.
cv::Mat static_mask(const cv::Mat& from_map, double limit, cv::Size size) {
  cv::Mat cells = from_map < limit;
  cv::morphologyEx(cells, cells, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));
  cv::Mat pixels;
  cv::resize(cells, pixels, size, 0, 0, cv::INTER_NEAREST);
  return pixels;
}

}  // namespace

void ClassPolicy::visit(OptionVisitor& v) {
  v("prior", prior, {.min = 0.001, .max = 0.999, .help = "probability that such an object moves"});
  v.choice("map", map, {{"never", Map::kNever}, {"when_static", Map::kWhenStatic}},
           {.help = "whether such an object may enter the map: never, or while it is static"});
}

void SurfacePolicy::visit(OptionVisitor& v) {
  v("prior", prior,
    {.min = 0.001, .max = 0.14, .help = "probability that a surface moves without evidence"});
  field.visit(v);
}

void Bayes::Options::visit(OptionVisitor& v) {
  v("classes", classes,
    {.help = "for each class: how likely its objects move, and whether they may be mapped"});
  v("other", other, {.help = "the same for all other classes"});
  v("objects", objects, {.help = "log-odds that a labelled object moves"});
  v("unlabelled", unlabelled, {.help = "evidence of single points on surfaces"});
  v("contradiction", contradiction,
    {.min = 0,
     .max = 100,
     .unit = "log-odds",
     .help = "evidence of the map check for static from which a surface is mapped although its "
             "class has map: never; smaller: people who rest may enter the map"});
  v("trusted_share", trusted_share,
    {.min = 0,
     .max = 1,
     .help = "share of the image labelled as movable up to which labels count in full"});
  v("doubted_share", doubted_share,
    {.min = 0,
     .max = 1,
     .help = "share of the image labelled as movable from which labels hardly count: too little is "
             "left to track on"});
  v.require(trusted_share < doubted_share, "trusted_share is not below doubted_share");
  v("margin", margin,
    {.min = 0,
     .max = 50,
     .unit = "px",
     .help = "border around moving objects that is excluded as well"});
}

Bayes::Bayes(const Options& options, const StageContext& context)
    : options_(options), beliefs_(options.objects), field_(options.unlabelled.field) {
  policies_.fill(options.other);
  bool is_any_known = false;
  for (const auto& [name, policy] : options.classes) {
    const int id = find_class(context.classes, name);
    if (id < 0) continue;
    policies_[static_cast<std::size_t>(id)] = policy;
    is_any_known = true;
  }
  if (!is_any_known && !context.classes.empty() && !options.classes.empty())
    context.log(LogLevel::kWarning, "decision.classes has none of the segmenter's classes (" +
                                        join(context.classes) +
                                        "): all are treated as decision.other");
}

StaticWeights Bayes::decide(const Frame& frame, const Segmentation& segmentation,
                            const MovingPoints& moving, const MapEvidence& evidence) {
  StaticWeights weights;
  field_.update(frame, moving);
  const cv::Mat from_map = on_cells(evidence, field_.log_odds().size());
  weigh_surfaces(frame, from_map, weights);
  weights.map = weights.track.clone();
  weigh_objects(frame, segmentation, moving, from_map, weights);
  return weights;
}

void Bayes::weigh_surfaces(const Frame& frame, const cv::Mat& from_map,
                           StaticWeights& weights) const {
  // A free-space violation overrides static points: the moving object may fill most of the image.
  cv::Mat field = field_.log_odds().clone();
  field.setTo(0, (from_map > 0) & (field < 0));
  field += from_map;
  const double prior = log_odds(options_.unlabelled.prior);
  cv::Mat cells(field.size(), CV_8U);
  for (int y = 0; y < field.rows; ++y) {
    const auto* evidence = field.ptr<float>(y);
    auto* weight = cells.ptr<std::uint8_t>(y);
    for (int x = 0; x < field.cols; ++x) weight[x] = weight_of(prior + evidence[x]);
  }
  cv::resize(cells, weights.track, frame.gray.size(), 0, 0, cv::INTER_NEAREST);
}

void Bayes::weigh_objects(const Frame& frame, const Segmentation& segmentation,
                          const MovingPoints& moving, const cv::Mat& from_map,
                          StaticWeights& weights) {
  const double trust = trust_in(segmentation);
  const double unlabelled = log_odds(options_.unlabelled.prior);
  std::vector<double> priors;
  for (const SegmentedObject& object : segmentation.objects)
    priors.push_back(std::lerp(unlabelled, log_odds(policy_of(object).prior), trust));
  const auto& beliefs = beliefs_.update(
      segmentation.objects, priors,
      moving.reliable ? count_points(segmentation, moving) : std::vector<PointCount>());
  for (std::size_t i = 0; i < beliefs.size(); ++i) {
    const bool moves = beliefs[i].moves;
    const std::uint8_t weight = moves ? 0 : weight_of(beliefs[i].log_odds);
    const bool never = policy_of(segmentation.objects[i]).map == ClassPolicy::Map::kNever;
    weights.object_moves.push_back(moves);
    if (weight == 255 && !never) continue;
    const cv::Size size = frame.gray.size();
    const double outweighed = kUnlikelyLogOdds - beliefs[i].log_odds;
    const ObjectMask tracked =
        mask_of(segmentation, i, options_.margin, static_mask(from_map, outweighed, size));
    lower(weights.track, size, tracked, weight);
    if (!never) {
      lower(weights.map, size, tracked, weight);
      continue;
    }
    const double contradicted =
        std::min(outweighed, -std::max(trust, kLeastContradiction) * options_.contradiction);
    const ObjectMask mapped =
        mask_of(segmentation, i, options_.margin, static_mask(from_map, contradicted, size));
    lower(weights.map, size, mapped, 0);
  }
}

/// The more of the image is labelled as movable classes, the less a label counts.
double Bayes::trust_in(const Segmentation& segmentation) const {
  constexpr double kMayMove = 0.5;  // prior
  double pixels = 0;
  for (const SegmentedObject& object : segmentation.objects)
    if (policy_of(object).prior > kMayMove) pixels += object.pixels;
  if (pixels == 0) return 1;
  const double share = pixels / static_cast<double>(segmentation.labels.total());
  const double trust =
      (options_.doubted_share - share) / (options_.doubted_share - options_.trusted_share);
  return std::clamp(trust, kMinLabelWeight, 1.0);
}

const ClassPolicy& Bayes::policy_of(const SegmentedObject& object) const {
  return policies_[static_cast<std::size_t>(object.label)];
}

/// Full weight while moving is unlikely, none when it is likely.
std::uint8_t Bayes::weight_of(double log_odds) const {
  constexpr double kUnlikely = 0.15;
  if (log_odds < kUnlikelyLogOdds) return 255;  // most surfaces: not even 0.12
  const double p = probability(log_odds);
  const double doubt = (p - kUnlikely) / (options_.objects.moves_above - kUnlikely);
  return static_cast<std::uint8_t>(std::lround(255 * (1 - std::clamp(doubt, 0.0, 1.0))));
}

}  // namespace stillpoint::decision_objects
