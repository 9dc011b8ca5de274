#include "people/figure.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace stillpoint::people {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNearestDrawn = 0.3;  // m
constexpr double kWidest = 0.6;        // heights from the middle

// Shares of a standing person's height; whoever sits has the thighs towards the camera.
constexpr double kKnees = 0.27;
constexpr double kHips = 0.51;
constexpr double kFolded = 0.85;     // share of the thighs that sitting hides
constexpr double kThighDepth = 0.2;  // m by which a seated person's knees are nearer

/// The height in the standing picture that is seen `up` of the height above the floor.
double unfolded(double up, double seated) {
  const double thigh = (kHips - kKnees) * (1 - kFolded * seated);
  if (up < kKnees) return up;
  if (up < kKnees + thigh) return kKnees + (up - kKnees) * (kHips - kKnees) / thigh;
  return up + (kHips - kKnees) - thigh;
}

double nearer_by(double own_up, double seated) {
  return kThighDepth * seated * std::clamp((kHips - own_up) / (kHips - kKnees), 0.0, 1.0);
}

}  // namespace

/// The plane of the picture, in the camera frame: a point of it is foot + across · a + up · b.
struct Figure::Board {
  Vector3d foot;
  Vector3d across;
  Vector3d up;
  Vector3d normal;

  /// (a, b, depth) where the ray (x, y, 1) meets it; depth <= 0: nowhere.
  Vector3d hit(double x, double y) const {
    const Vector3d ray(x, y, 1);
    const double z = normal.dot(foot) / normal.dot(ray);
    const Vector3d point = z * ray - foot;
    return {across.dot(point), up.dot(point), z};
  }
};

Figure::Figure(PersonPlan plan, CutOut cut, double lower, int seed)
    : plan_(std::move(plan)),
      levels_(levels_of(std::move(cut))),
      lower_(lower),
      rhythm_(static_cast<double>(seed % 628) / 100) {}

void Figure::relight(const cv::Scalar& gain) {
  for (CutOut& level : levels_) cv::multiply(level.bgr, gain, level.bgr);
}

Figure::Board Figure::board_at(const Pose& level_from_camera, const Stance& stance,
                               double time) const {
  const double bob = 0.02 * stance.walking * std::sin(2 * stance.stride);
  const Vector3d foot(stance.foot.x(), stance.foot.y(), plan_.elevation - lower_ + bob);
  Vector3d away = foot - level_from_camera.translation();
  away.z() = 0;
  away.normalize();
  const double sway =
      0.012 * std::sin(2.1 * time + rhythm_) + 0.02 * stance.walking * std::sin(stance.stride);
  const Eigen::AngleAxisd leaning(sway, away);
  const Eigen::Matrix3d camera_from_level = level_from_camera.linear().transpose();
  const Vector3d up = leaning * Vector3d::UnitZ();
  return {.foot = level_from_camera.inverse() * foot,
          .across = camera_from_level * away.cross(up).normalized(),
          .up = camera_from_level * up,
          .normal = camera_from_level * away};
}

/// Who walks swings the legs; what is above the knees is never quite still, hands least of all.
struct Figure::Swing {
  double height;  // m
  double seated;
  bool mirrored;
  double spread;       // of the legs, relative
  double shift;        // of the feet, heights
  double ripple;       // heights
  double phase;        // rad
  double left, right;  // lift of the hands, heights

  /// Where in the standing picture (in its heights, across from its middle and up) the place
  /// `across` and `up` (m) of the person as they are now comes from.
  Vector2d own_place(double across, double up) const {
    const double own_up = unfolded(up / height, seated);
    const double leg = std::clamp((kHips - own_up) / kHips, 0.0, 1.0);
    double x = across / height / (1 + spread * leg) + shift * leg;
    const double upper = std::clamp((own_up - kKnees) / 0.2, 0.0, 1.0);
    x += ripple * upper * std::sin(9 * own_up + phase);
    const double hands = std::clamp(std::abs(x) / 0.12, 0.0, 1.0);
    return {mirrored ? -x : x, own_up + upper * hands * (x > 0 ? right : left)};
  }
};

Figure::Swing Figure::swing_at(const Stance& stance, double time) const {
  return {.height = plan_.height,
          .seated = stance.seated,
          .mirrored = stance.to_the_left,
          .spread = 0.3 * stance.walking * std::sin(stance.stride + rhythm_),
          .shift = 0.03 * stance.walking * std::sin(2 * stance.stride),
          .ripple = 0.003 + 0.004 * stance.walking,
          .phase = 4 * time + rhythm_,
          .left = 0.012 * std::sin(3.1 * time + rhythm_),
          .right = 0.012 * std::sin(3.1 * time + rhythm_ + 2)};
}

/// Which place of which cut-out every pixel of the layer sees.
struct Figure::Traced {
  const CutOut* cut = nullptr;  // null: nobody to be seen
  cv::Mat map;                  // CV_32FC2, of the layer's box
  Layer layer;                  // box and z only

  cv::Mat warped(const cv::Mat& image) const {
    cv::Mat whole = cv::Mat::zeros(layer.z.size(), image.type()), part;
    cv::remap(image, part, map, cv::noArray(), cv::INTER_LINEAR);
    part.copyTo(whole(layer.box));
    return whole;
  }
};

/// The level whose pixels are about as large as those of the recording.
const CutOut& Figure::level_for(double distance, double focal) const {
  const double own_pixels = levels_.front().alpha.rows * distance / (plan_.height * focal);
  const long deepest = std::ssize(levels_) - 1;
  const long level = std::clamp(std::lround(std::log2(own_pixels)), 0L, deepest);
  return levels_[static_cast<std::size_t>(level)];
}

/// Pixels that may see the picture, by a look at some of them.
cv::Rect Figure::rough_box(const Board& board, const Rays& rays) const {
  constexpr int kStep = 8;  // px
  const double margin = 4 * kStep * board.normal.dot(board.foot) / rays.focal();
  cv::Rect box;
  for (int y = 0; y < rays.size().height; y += kStep) {
    for (int x = 0; x < rays.size().width; x += kStep) {
      const Vector3d at = board.hit(rays.at(y, x)[0], rays.at(y, x)[1]);
      const bool near = at.z() >= kNearestDrawn && at.y() > -margin &&
                        at.y() < 1.05 * plan_.height + margin &&
                        std::abs(at.x()) < kWidest * plan_.height + margin;
      if (near) box |= cv::Rect(x - kStep, y - kStep, 2 * kStep + 1, 2 * kStep + 1);
    }
  }
  return box & cv::Rect({}, rays.size());
}

Figure::Traced Figure::trace(const Pose& level_from_camera, const Rays& rays, double time) const {
  const Stance stance = stance_at(plan_, time);
  const Board board = board_at(level_from_camera, stance, time);
  const Swing swing = swing_at(stance, time);
  const double distance = board.normal.dot(board.foot);
  if (distance < kNearestDrawn) return {};
  const cv::Rect box = rough_box(board, rays);
  if (box.empty()) return {};
  const CutOut& cut = level_for(distance, rays.focal());
  const double scale = cut.alpha.rows;
  Traced traced{.cut = &cut, .map = cv::Mat(box.size(), CV_32FC2, cv::Scalar::all(-9))};
  traced.layer.box = box;
  traced.layer.z = cv::Mat::zeros(rays.size(), CV_32F);
  for (int y = box.y; y < box.br().y; ++y) {
    for (int x = box.x; x < box.br().x; ++x) {
      const cv::Vec2f& ray = rays.at(y, x);
      const Vector3d at = board.hit(ray[0], ray[1]);
      const bool off = at.z() < kNearestDrawn || at.y() < 0 || at.y() > 1.05 * plan_.height ||
                       std::abs(at.x()) > kWidest * plan_.height;
      if (off) continue;
      const Vector2d own = swing.own_place(at.x(), at.y());
      traced.map.at<cv::Vec2f>(y - box.y, x - box.x) = {
          static_cast<float>(own.x() * scale + 0.5 * cut.alpha.cols - 0.5),
          static_cast<float>((1 - own.y()) * scale - 0.5)};
      traced.layer.z.at<float>(y, x) =
          static_cast<float>(at.z() - nearer_by(own.y(), stance.seated));
    }
  }
  return traced;
}

Layer Figure::shape_of(const Traced& traced) const {
  if (!traced.cut) return {};
  Layer layer = traced.layer;
  layer.alpha = traced.warped(traced.cut->alpha);
  layer.z -= plan_.height * traced.warped(traced.cut->relief);
  return layer;
}

Layer Figure::shape_from(const Pose& level_from_camera, const Rays& rays, double time) const {
  return shape_of(trace(level_from_camera, rays, time));
}

Layer Figure::seen_from(const Pose& level_from_camera, const Rays& rays, double time) const {
  const Traced traced = trace(level_from_camera, rays, time);
  Layer layer = shape_of(traced);
  if (traced.cut) layer.bgr = traced.warped(traced.cut->bgr);
  return layer;
}

}  // namespace stillpoint::people
