#include "map_checks/surface_verdicts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace stillpoint {
namespace {

constexpr int kLanes = cv::v_float32::nlanes;
constexpr float kMinDepth = 0.1F;  // m before a view
// Nearest and farthest of the neighbours this many tolerances apart: an edge, between two surfaces.
constexpr float kEdge = 5.0F;
constexpr float kSameSurface = 0.03F;  // of the depth, between neighbouring cells

/// What has been said of one cell.
struct Verdict {
  float resting = 0.0F;  // s, age of the oldest view of the unbroken row that saw it there
  std::uint8_t came_in = 0;
  std::array<std::uint8_t, 3> same = {};  // by Trust
};

class Judge {
 public:
  Judge(const cv::Mat& depth, const CellCamera& camera, const VerdictOptions& options)
      : depth_(depth),
        camera_(camera),
        options_(options),
        verdicts_(depth.total()),
        margin_(static_cast<float>(options.margin)),
        tolerance_(static_cast<float>(options.tolerance)),
        noise_(static_cast<float>(options.noise)),
        columns_(static_cast<std::size_t>(cv::alignSize(depth.cols, kLanes))),
        row_(columns_.size()),
        cells_(columns_.size()),
        z_(columns_.size()) {
    std::iota(columns_.begin(), columns_.end(), 0.0F);
  }

  void ask(const View& view, const Pose& world_from_camera, double time) {
    const Pose view_from_camera = view.world_from_camera.inverse() * world_from_camera;
    const auto age = static_cast<float>(time - view.time);
    const bool tells_rest =
        age >= options_.min_age || view_from_camera.translation().norm() >= options_.min_parallax;
    for (int y = 0; y < depth_.rows; ++y) {
      project_row(y, view, view_from_camera);
      Verdict* verdict = &verdicts_[static_cast<std::size_t>(y) * depth_.cols];
      for (std::size_t x = 0; x < static_cast<std::size_t>(depth_.cols); ++x)
        if (cells_[x] >= 0) ask(view, cells_[x], z_[x], age, tells_rest, verdict[x]);
    }
  }

  cv::Mat log_odds() const {
    cv::Mat result(depth_.size(), CV_32F);
    auto* out = result.ptr<float>();
    const auto range = static_cast<float>(options_.range);
    for (std::size_t i = 0; i < verdicts_.size(); ++i)
      out[i] = std::clamp(evidence_of(verdicts_[i]), -range, range);
    return result;
  }

 private:
  // Fills cells_ and z_: where the view sees the cells of a row, and how far from it they are.
  void project_row(int y, const View& view, const Pose& view_from_camera) {
    const Eigen::Matrix3f r = view_from_camera.linear().cast<float>();
    const Eigen::Vector3f t = view_from_camera.translation().cast<float>();
    // Rays of the row in cells of the view, so that (x, y) / z is a place in it; rounded below.
    Eigen::Matrix3f calibration = Eigen::Matrix3f::Identity();
    calibration << view.camera.fx, 0, view.camera.cx + 0.5F,  //
        0, view.camera.fy, view.camera.cy + 0.5F, 0, 0, 1;
    const Eigen::Vector3f first = calibration * r * camera_.unproject(0, static_cast<float>(y), 1);
    const Eigen::Vector3f step = calibration * r.col(0) / camera_.fx;
    const Eigen::Vector3f offset = calibration * t;
    std::copy_n(depth_.ptr<float>(y), depth_.cols, row_.begin());
    const cv::v_float32 zero = cv::vx_setzero_f32();
    const cv::v_float32 width = cv::vx_setall_f32(static_cast<float>(view.depth.cols));
    const cv::v_float32 height = cv::vx_setall_f32(static_cast<float>(view.depth.rows));
    const cv::v_float32 nearest = cv::vx_setall_f32(kMinDepth);
    const cv::v_int32 row_length = cv::vx_setall_s32(view.depth.cols);
    const cv::v_int32 none = cv::vx_setall_s32(-1);
    const auto along = [&](int axis, const cv::v_float32& d, const cv::v_float32& column) {
      const auto all = [](float value) { return cv::vx_setall_f32(value); };
      return d * (all(first[axis]) + column * all(step[axis])) + all(offset[axis]);
    };
    for (int x = 0; x < depth_.cols; x += kLanes) {
      const cv::v_float32 column = cv::vx_load(&columns_[static_cast<std::size_t>(x)]);
      const cv::v_float32 d = cv::vx_load(&row_[static_cast<std::size_t>(x)]);
      const cv::v_float32 z = along(2, d, column);
      const cv::v_float32 inverse = cv::vx_setall_f32(1) / cv::v_max(z, nearest);
      const cv::v_float32 u = along(0, d, column) * inverse, v = along(1, d, column) * inverse;
      const cv::v_float32 inside =
          (d > zero) & (z > nearest) & (u >= zero) & (v >= zero) & (u < width) & (v < height);
      const cv::v_int32 cell = cv::v_trunc(v) * row_length + cv::v_trunc(u);
      cv::v_store(&cells_[static_cast<std::size_t>(x)],
                  cv::v_select(cv::v_reinterpret_as_s32(inside), cell, none));
      cv::v_store(&z_[static_cast<std::size_t>(x)], z);
    }
  }

  void ask(const View& view, int cell, float z, float age, bool tells_rest,
           Verdict& verdict) const {
    const auto [near, far] = view.bounds.ptr<cv::Vec2f>()[cell].val;
    if (far <= 0) return;
    const float noise = noise_ * z * z;
    if (z < near - margin_ - noise) {
      if (verdict.resting < options_.rest_time) ++verdict.came_in;
      return;
    }
    const float tolerance = tolerance_ + noise;
    if (z < near - tolerance || z > far + tolerance) return;
    const auto off = [&](float surface) { return std::abs(z - surface) > tolerance; };
    if (far - near > kEdge * tolerance && off(near) && off(far) &&
        off(view.depth.ptr<float>()[cell]))
      return;
    if (verdict.came_in == 0) verdict.resting = std::max(verdict.resting, age);
    if (!tells_rest) return;
    ++verdict.same[view.trust.ptr<std::uint8_t>()[cell]];
  }

  float evidence_of(const Verdict& verdict) const {
    const double untrusted = verdict.resting >= options_.rest_time ? options_.same_untrusted : 0.0;
    return static_cast<float>(
        options_.came_in * verdict.came_in - options_.same_mapped * verdict.same[kMapped] -
        options_.same_tracked * verdict.same[kTracked] - untrusted * verdict.same[kUntrusted]);
  }

  const cv::Mat& depth_;
  const CellCamera& camera_;
  const VerdictOptions& options_;
  std::vector<Verdict> verdicts_;
  float margin_, tolerance_, noise_;
  // Of one row, as long as vectors need.
  std::vector<float> columns_;  // 0, 1, 2 …
  std::vector<float> row_;      // m, depth
  std::vector<int> cells_;      // in the view; -1: none
  std::vector<float> z_;        // m, from the view
};

/// Single cells that stand out are noise at edges.
void remove_specks(cv::Mat& log_odds) {
  const cv::Mat around = cv::Mat::ones(3, 3, CV_8U);
  cv::Mat came_in = log_odds > 0, opened;
  cv::morphologyEx(came_in, opened, cv::MORPH_OPEN, around);
  log_odds.setTo(0, came_in & ~opened);
  cv::Mat same = log_odds < 0;
  cv::morphologyEx(same, opened, cv::MORPH_OPEN, around);
  log_odds.setTo(0, same & ~opened);
}

/// What has come in goes on where no view knows the place, as far as the same surface does.
void grow(cv::Mat& log_odds, const cv::Mat& depth, const CellCamera& camera, float reach) {
  struct Step {
    cv::Point cell;
    float left;  // m
  };
  std::vector<Step> front;
  for (int y = 0; y < depth.rows; ++y)
    for (int x = 0; x < depth.cols; ++x)
      if (log_odds.at<float>(y, x) > 0) front.push_back({{x, y}, reach});
  const cv::Rect inside({}, depth.size());
  for (std::size_t i = 0; i < front.size(); ++i) {
    const Step step = front[i];
    const float z = depth.at<float>(step.cell);
    const float left = step.left - z / camera.fx;
    if (left <= 0) continue;
    const float evidence = log_odds.at<float>(step.cell);
    for (const cv::Point side : {cv::Point(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
      const cv::Point next = step.cell + side;
      if (!inside.contains(next) || log_odds.at<float>(next) != 0) continue;
      const float other = depth.at<float>(next);
      if (other <= 0 || std::abs(other - z) > kSameSurface * z) continue;
      log_odds.at<float>(next) = evidence;
      front.push_back({next, left});
    }
  }
}

}  // namespace

void VerdictOptions::visit(OptionVisitor& v) {
  v("margin", margin,
    {.min = 0, .max = 10, .unit = "m", .help = "before what was seen there: it has come in"});
  v("tolerance", tolerance,
    {.min = 0, .max = 10, .unit = "m", .help = "from what was seen there: it stands there still"});
  v("noise", noise,
    {.min = 0,
     .max = 1,
     .unit = "m",
     .help = "at 1 m that margin and tolerance grow by, with the square of the depth"});
  v("rest_time", rest_time,
    {.min = 0, .max = 600, .unit = "s", .help = "until what has come in counts as resting"});
  v("min_age", min_age,
    {.min = 0,
     .max = 600,
     .unit = "s",
     .help = "of a view from the same place, to tell who rests"});
  v("min_parallax", min_parallax,
    {.min = 0, .max = 100, .unit = "m", .help = "between two viewpoints, to tell who rests"});
  v("came_in", came_in,
    {.min = 0, .max = 100, .unit = "log-odds", .help = "of each view that looked through"});
  v("same_mapped", same_mapped,
    {.min = 0,
     .max = 100,
     .unit = "log-odds",
     .help = "of each view that saw and mapped it there"});
  v("same_tracked", same_tracked,
    {.min = 0, .max = 100, .unit = "log-odds", .help = "of each that saw and only tracked it"});
  v("same_untrusted", same_untrusted,
    {.min = 0, .max = 100, .unit = "log-odds", .help = "of each that saw it and did neither"});
  v("range", range, {.min = 0, .max = 100, .unit = "log-odds", .help = "of all views, at most"});
  v("reach", reach,
    {.min = 0, .max = 10, .unit = "m", .help = "of what has come in, where no view knows"});
}

cv::Mat judge_surfaces(const cv::Mat& depth, const CellCamera& camera,
                       const Pose& world_from_camera, double time,
                       std::span<const View* const> views, const VerdictOptions& options) {
  Judge judge(depth, camera, options);
  for (const View* view : views) judge.ask(*view, world_from_camera, time);
  cv::Mat log_odds = judge.log_odds();
  remove_specks(log_odds);
  grow(log_odds, depth, camera, static_cast<float>(options.reach));
  return log_odds;
}

}  // namespace stillpoint
