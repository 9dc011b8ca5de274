#include "map_checks/surface_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace stillpoint::map_checks {
namespace {

constexpr int kLanes = cv::v_float32::nlanes;
constexpr float kMinDepth = 0.1F;  // m before a view: no camera measures nearer, and 1 / z is safe
// Nearest and farthest neighbour this many tolerances apart: a depth discontinuity.
constexpr float kTolerancesAtEdge = 5.0F;
constexpr float kSigmas = 5.0F;        // of the depth, by which both margin and tolerance are wider
constexpr float kSameSurface = 0.03F;  // of the depth, between neighbouring cells

// Evidence on the cells of a row.
struct ViewCounts {
  std::vector<float> resting;     // s, age of the oldest view that saw it there, no violation since
  std::vector<float> violations;  // views with a free-space violation
  std::array<std::vector<float>, 3> same;  // views that saw it there, by Trust

  void clear(std::size_t cells) {
    resting.assign(cells, 0.0F);
    violations.assign(cells, 0.0F);
    for (std::vector<float>& count : same) count.assign(cells, 0.0F);
  }
};

// An earlier view relative to the current frame.
struct PastView {
  const View* view;
  Eigen::Matrix3f rotation;     // view_from_camera
  Eigen::Vector3f translation;  // m
  float age;                    // s
  bool is_static_evidence;
};

// Works row by row, so that the evidence stays in the cache.
class EvidenceOfViews {
 public:
  EvidenceOfViews(const cv::Mat& depth, const CellCamera& camera,
                  const SurfaceEvidenceOptions& options)
      : depth_(depth),
        camera_(camera),
        options_(options),
        row_length_(static_cast<std::size_t>(cv::alignSize(depth.cols, kLanes))),
        columns_(row_length_),
        row_(row_length_),
        cells_(row_length_),
        z_(row_length_) {
    std::iota(columns_.begin(), columns_.end(), 0.0F);
  }

  cv::Mat log_odds(std::span<const View* const> views, const Pose& world_from_camera, double time) {
    std::vector<PastView> past_views;
    for (const View* view : views) past_views.push_back(past_view(*view, world_from_camera, time));
    cv::Mat result(depth_.size(), CV_32F);
    const auto limit = static_cast<float>(options_.max_log_odds);
    for (int y = 0; y < depth_.rows; ++y) {
      counts_.clear(row_length_);
      for (const PastView& past : past_views) {
        project_row(y, past);
        compare_row(past);
      }
      auto* out = result.ptr<float>(y);
      for (std::size_t x = 0; x < static_cast<std::size_t>(depth_.cols); ++x)
        out[x] = std::clamp(evidence_of(x), -limit, limit);
    }
    return result;
  }

 private:
  PastView past_view(const View& view, const Pose& world_from_camera, double time) const {
    const Pose view_from_camera = view.world_from_camera.inverse() * world_from_camera;
    const auto age = static_cast<float>(time - view.time);
    const bool apart = view_from_camera.translation().norm() >= options_.min_parallax;
    return {&view, view_from_camera.linear().cast<float>(),
            view_from_camera.translation().cast<float>(), age, apart || age >= options_.min_age};
  }

  // Projects a row into the view: fills cells_ (cell of the view) and z_ (depth from the view).
  void project_row(int y, const PastView& past) {
    const View& view = *past.view;
    // Rays of the row in homogeneous cell coordinates of the view; + 0.5 as truncation rounds.
    Eigen::Matrix3f calibration = Eigen::Matrix3f::Identity();
    calibration << view.camera.fx, 0, view.camera.cx + 0.5F,  //
        0, view.camera.fy, view.camera.cy + 0.5F, 0, 0, 1;
    const Eigen::Vector3f first =
        calibration * past.rotation * camera_.unproject(0, static_cast<float>(y), 1);
    const Eigen::Vector3f step = calibration * past.rotation.col(0) / camera_.fx;
    const Eigen::Vector3f offset = calibration * past.translation;
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

  // Compares cells_ and z_ with the view. A free-space violation does not count once newer
  // views, which are compared first, have seen the surface there for rest_time.
  void compare_row(const PastView& past) {
    const View& view = *past.view;
    const auto all = [](double value) { return cv::vx_setall_f32(static_cast<float>(value)); };
    const cv::v_float32 one = all(1), zero = all(0);
    for (std::size_t x = 0; x < row_length_; x += kLanes) {
      const cv::v_int32 cell = cv::vx_load(&cells_[x]);
      const cv::v_float32 known = cv::v_reinterpret_as_f32(cell >= cv::vx_setzero_s32());
      if (!cv::v_check_any(known)) continue;
      const cv::v_int32 place = cv::v_max(cell, cv::vx_setzero_s32());
      const cv::v_float32 z = cv::vx_load(&z_[x]);
      cv::v_float32 near, far;
      cv::v_lut_deinterleave(view.bounds.ptr<float>(), place + place, near, far);
      const cv::v_float32 measured = known & (far > zero);
      const cv::v_float32 noise = all(kSigmas * camera_.surface_noise) * z * z;
      const cv::v_float32 tolerance = all(options_.tolerance) + noise;

      const cv::v_float32 resting = cv::vx_load(&counts_.resting[x]);
      const cv::v_float32 through = measured & (z < near - all(options_.margin) - noise) &
                                    (resting < all(options_.rest_time));
      const cv::v_float32 free_space_violation =
          cv::vx_load(&counts_.violations[x]) + (through & one);
      cv::vx_store(&counts_.violations[x], free_space_violation);

      const cv::v_float32 between = (z >= near - tolerance) & (z <= far + tolerance);
      const auto off = [&](const cv::v_float32& surface) {
        return cv::v_abs(z - surface) > tolerance;
      };
      const cv::v_float32 edge = far - near > all(kTolerancesAtEdge) * tolerance;
      const cv::v_float32 beside =
          edge & off(near) & off(far) & off(cv::v_lut(view.depth.ptr<float>(), place));
      const cv::v_float32 same = measured & between & ~beside;
      const cv::v_float32 rests = same & (free_space_violation == zero);
      cv::vx_store(&counts_.resting[x], cv::v_max(resting, rests & all(past.age)));
      if (past.is_static_evidence) count_same(x, same, cv::v_lut(view.trust.ptr<int>(), place));
    }
  }

  void count_same(std::size_t x, const cv::v_float32& same, const cv::v_int32& trust) {
    for (int kind = kNotStatic; kind <= kMapped; ++kind) {
      float* count = &counts_.same[static_cast<std::size_t>(kind)][x];
      const cv::v_float32 counts =
          cv::v_reinterpret_as_f32(trust == cv::vx_setall_s32(kind)) & same;
      cv::vx_store(count, cv::vx_load(count) + (counts & cv::vx_setall_f32(1)));
    }
  }

  float evidence_of(std::size_t x) const {
    const double unused = counts_.resting[x] >= options_.rest_time ? options_.static_unused : 0.0;
    return static_cast<float>(options_.free_space_violation * counts_.violations[x] -
                              options_.static_mapped * counts_.same[kMapped][x] -
                              options_.static_tracked * counts_.same[kTracked][x] -
                              unused * counts_.same[kNotStatic][x]);
  }

  const cv::Mat& depth_;
  const CellCamera& camera_;
  const SurfaceEvidenceOptions& options_;
  std::size_t row_length_;
  // Of one row.
  ViewCounts counts_;
  std::vector<float> columns_;  // 0, 1, 2 …
  std::vector<float> row_;      // m, depth
  std::vector<int> cells_;      // in the view; -1: none
  std::vector<float> z_;        // m, from the view
};

/// Isolated cells are noise at depth discontinuities.
void remove_specks(cv::Mat& log_odds) {
  const cv::Mat around = cv::Mat::ones(3, 3, CV_8U);
  cv::Mat free_space_violation = log_odds > 0, opened;
  cv::morphologyEx(free_space_violation, opened, cv::MORPH_OPEN, around);
  log_odds.setTo(0, free_space_violation & ~opened);
  cv::Mat same = log_odds < 0;
  cv::morphologyEx(same, opened, cv::MORPH_OPEN, around);
  log_odds.setTo(0, same & ~opened);
}

/// Grows free-space violations over connected cells of the same surface without evidence.
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

void SurfaceEvidenceOptions::visit(OptionVisitor& v) {
  v("margin", margin,
    {.min = 0,
     .max = 10,
     .unit = "m",
     .help = "a surface this far in front of an earlier one violates its free space; plus five "
             "standard deviations of the depth"});
  v("tolerance", tolerance,
    {.min = 0,
     .max = 10,
     .unit = "m",
     .help = "a surface this near to an earlier one is the same; plus five standard deviations of "
             "the depth"});
  v("rest_time", rest_time,
    {.min = 0,
     .max = 600,
     .unit = "s",
     .help = "how long an object that was put down must rest to be static"});
  v("min_age", min_age,
    {.min = 0,
     .max = 600,
     .unit = "s",
     .help = "age from which an earlier view counts as evidence for static; from the same "
             "viewpoint, younger ones saw what pauses"});
  v("min_parallax", min_parallax,
    {.min = 0,
     .max = 100,
     .unit = "m",
     .help = "distance between the viewpoints from which views younger than min_age count, too"});
  v("free_space_violation", free_space_violation,
    {.min = 0,
     .max = 100,
     .unit = "log-odds",
     .help = "added for each view that saw free space where the surface is"});
  v("static_mapped", static_mapped,
    {.min = 0,
     .max = 100,
     .unit = "log-odds",
     .help = "subtracted for each view that saw the surface there and used it for the map"});
  v("static_tracked", static_tracked,
    {.min = 0,
     .max = 100,
     .unit = "log-odds",
     .help = "subtracted for each view that saw it there and used it for tracking only"});
  v("static_unused", static_unused,
    {.min = 0,
     .max = 100,
     .unit = "log-odds",
     .help =
         "subtracted for each view that saw it there and used it for neither, after rest_time"});
  v("max_log_odds", max_log_odds,
    {.min = 0,
     .max = 100,
     .unit = "log-odds",
     .help = "limit of the sum over all views, in both directions"});
  v.require(margin >= tolerance, "margin is less than tolerance");
  v("reach", reach,
    {.min = 0,
     .max = 10,
     .unit = "m",
     .help =
         "how far a free-space violation spreads along its surface into parts without evidence"});
}

cv::Mat surface_evidence(const cv::Mat& depth, const CellCamera& camera,
                         const Pose& world_from_camera, double time,
                         std::span<const View* const> views,
                         const SurfaceEvidenceOptions& options) {
  cv::Mat log_odds =
      EvidenceOfViews(depth, camera, options).log_odds(views, world_from_camera, time);
  remove_specks(log_odds);
  grow(log_odds, depth, camera, static_cast<float>(options.reach));
  return log_odds;
}

}  // namespace stillpoint::map_checks
