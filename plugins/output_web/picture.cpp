#include "output_web/picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "output_web/message_writer.hpp"
#include "stillpoint/support/image_codec.hpp"

namespace stillpoint::output_web {
namespace {

using Use = TrackedFeature::Use;

constexpr int kJpegQuality = 80;
constexpr int kMaskStep = 2;           // px
constexpr int kCloudStep = 8;          // px
constexpr float kPixelSteps = 8;       // of a coordinate, per px
constexpr float kNear = 8;             // px from a moving point
constexpr float kMillimetres = 1000;   // per metre
constexpr float kFarthest = 65.f;      // metres that a cloud can hold
constexpr std::uint8_t kUsable = 128;  // of a weight

/// Why a feature counts as moving, as far as a report tells; several may hold.
enum Reason : std::uint8_t {
  kLabelled = 1,      ///< on an object of a class
  kObjectMoves = 2,   ///< on an object that the decision takes for moving
  kFreeSpace = 4,     ///< where earlier frames saw free space
  kMovingPoint = 8,   ///< beside a moving point
  kWeightAtZero = 16  ///< the decision's weight is zero
};

/// The value at a pixel; 0 where the image does not have it.
template <class T>
T at(const cv::Mat& image, int u, int v) {
  const bool inside = u >= 0 && v >= 0 && u < image.cols && v < image.rows;
  return inside ? image.at<T>(v, u) : T{};
}

std::uint16_t pixel(float coordinate) {
  return static_cast<std::uint16_t>(std::clamp(std::lround(kPixelSteps * coordinate), 0L, 65535L));
}

void write_pixel(const cv::Point2f& point, MessageWriter& writer) {
  writer.number(pixel(point.x));
  writer.number(pixel(point.y));
}

void write_image(const FrameReport& report, MessageWriter& writer) {
  const std::vector<std::uint8_t> jpeg =
      encode_image(".jpg", report.frame->bgr, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  writer.begin(Record::kImage);
  writer.number(report.frame->index);
  writer.text({reinterpret_cast<const char*>(jpeg.data()), jpeg.size()});
  writer.end();
}

bool near_moving_point(const MovingPoints& moving, const cv::Point2f& at) {
  return std::ranges::any_of(moving.points, [&](const PointMotion& point) {
    return point.moving && std::abs(point.current.x - at.x) < kNear &&
           std::abs(point.current.y - at.y) < kNear;
  });
}

std::uint8_t reasons_of(const FrameReport& report, const cv::Point2f& where, std::uint8_t label) {
  const int u = cvRound(where.x), v = cvRound(where.y);
  const cv::Mat& cells = report.evidence.log_odds;
  const cv::Size size = report.frame->bgr.size();
  int reasons = label > 0 ? kLabelled : 0;
  if (report.segmentation && report.weights) {
    const std::size_t object = at<std::uint8_t>(report.segmentation->instances, u, v);
    const std::vector<bool>& moves = report.weights->object_moves;
    if (object > 0 && object <= moves.size() && moves[object - 1]) reasons |= kObjectMoves;
  }
  if (!cells.empty() &&
      at<float>(cells, u * cells.cols / size.width, v * cells.rows / size.height) > 0)
    reasons |= kFreeSpace;
  if (near_moving_point(report.moving, where)) reasons |= kMovingPoint;
  const cv::Mat weights = report.weights ? report.weights->track : cv::Mat();
  if (!weights.empty() && at<std::uint8_t>(weights, u, v) == 0) reasons |= kWeightAtZero;
  return static_cast<std::uint8_t>(reasons);
}

void write_features(const FrameReport& report, MessageWriter& writer) {
  const cv::Mat labels = report.segmentation ? report.segmentation->labels : cv::Mat();
  writer.begin(Record::kFeatures);
  for (const TrackedFeature& feature : report.result.tracked) {
    const auto label = at<std::uint8_t>(labels, cvRound(feature.pixel.x), cvRound(feature.pixel.y));
    write_pixel(feature.pixel, writer);
    writer.number(static_cast<std::uint8_t>(feature.use));
    writer.number(label);
    writer.number(feature.use == Use::kMoving ? reasons_of(report, feature.pixel, label)
                                              : std::uint8_t{0});
  }
  writer.end();
}

void write_moving_points(const MovingPoints& moving, MessageWriter& writer) {
  writer.begin(Record::kMovingPoints);
  for (const PointMotion& point : moving.points) {
    if (!point.moving) continue;
    write_pixel(point.previous, writer);
    write_pixel(point.current, writer);
  }
  writer.end();
}

// Runs of equal pixels, row by row: class and whether tracking does not use it.
void write_mask(const FrameReport& report, MessageWriter& writer) {
  const cv::Size size = report.frame->bgr.size();
  const cv::Mat labels = report.segmentation ? report.segmentation->labels : cv::Mat();
  const cv::Mat weights = report.weights ? report.weights->track : cv::Mat();
  const int columns = size.width / kMaskStep, rows = size.height / kMaskStep;
  writer.begin(Record::kMask);
  writer.number(static_cast<std::uint16_t>(columns));
  writer.number(static_cast<std::uint16_t>(rows));
  std::uint16_t length = 0;
  std::uint8_t label = 0, unused = 0;
  const auto write_run = [&] {
    if (length == 0) return;
    writer.number(label);
    writer.number(unused);
    writer.number(length);
    length = 0;
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int u = kMaskStep * column, v = kMaskStep * row;
      const auto its_label = at<std::uint8_t>(labels, u, v);
      const std::uint8_t its_unused =
          !weights.empty() && at<std::uint8_t>(weights, u, v) < kUsable ? 1 : 0;
      if (its_label != label || its_unused != unused || length == 65535) write_run();
      label = its_label;
      unused = its_unused;
      ++length;
    }
  write_run();
  writer.end();
}

}  // namespace

std::string picture_of(const FrameReport& report) {
  MessageWriter writer;
  write_image(report, writer);
  write_features(report, writer);
  write_moving_points(report.moving, writer);
  write_mask(report, writer);
  return writer.take();
}

std::string cloud_of(const FrameReport& report, KeyFrameId keyframe) {
  const Frame& frame = *report.frame;
  const cv::Mat labels = report.segmentation ? report.segmentation->labels : cv::Mat();
  const cv::Mat weights = report.weights ? report.weights->map : cv::Mat();
  const int columns = frame.depth.cols / kCloudStep, rows = frame.depth.rows / kCloudStep;
  MessageWriter writer;
  writer.begin(Record::kCloud);
  writer.number(keyframe);
  writer.number(static_cast<std::uint16_t>(kCloudStep));
  writer.number(static_cast<std::uint16_t>(columns));
  writer.number(static_cast<std::uint16_t>(rows));
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int u = kCloudStep * column + kCloudStep / 2, v = kCloudStep * row + kCloudStep / 2;
      const float depth = frame.depth.at<float>(v, u);
      const bool used = depth > 0 && depth < kFarthest &&
                        (weights.empty() || at<std::uint8_t>(weights, u, v) >= kUsable);
      const auto bgr = at<cv::Vec3b>(frame.bgr, u, v);
      writer.number(used ? static_cast<std::uint16_t>(kMillimetres * depth) : std::uint16_t{0});
      for (const int channel : {2, 1, 0}) writer.number(bgr[channel]);
      writer.number(at<std::uint8_t>(labels, u, v));
    }
  writer.end();
  return writer.take();
}

}  // namespace stillpoint::output_web
