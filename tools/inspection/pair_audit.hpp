// What is found out about colour and depth images, wherever a recording has them.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "inspection/depth_statistics.hpp"
#include "inspection/stream_audit.hpp"
#include "inspection/time_offset.hpp"
#include "stillpoint/contracts/camera.hpp"

namespace stillpoint::inspection {

struct PairAudit {
  std::optional<CameraModel> camera;        ///< to compare image sizes and scale depth with
  std::optional<CameraModel> depth_camera;  ///< of depth that is not registered
  double depth_factor = 5000.0;             ///< raw depth of one metre: the camera's, or assumed
  StreamAudit color, depth, pairs;
  double mean_difference = 0.0;            ///< seconds between colour and depth of a pair
  double max_difference = 0.0;             ///< seconds
  std::size_t sampled = 0;                 ///< pairs whose images were read
  std::map<std::string, int> color_kinds;  ///< "640 x 480, 8 bit, 3 channels, jpg" → how many
  std::map<std::string, int> depth_kinds;
  std::vector<std::string> unreadable;  ///< of the sampled images: where and why
  int dark_images = 0;                  ///< of the sampled colour images
  int overexposed_images = 0;           ///< of the sampled colour images: a third or more is white
  DepthStatistics depth_values;         ///< of those that were read, as if they had 16 bits
  TimeOffset time_offset;
  std::vector<std::string> warnings;  ///< what a user should know or do, most important first
};

/// When the images of a pair were taken.
struct PairStamps {
  double color = 0.0;  ///< seconds
  double depth = 0.0;  ///< seconds
};

/// All stamps in seconds, in order.
void audit_stamps(const std::vector<double>& color, const std::vector<double>& depth,
                  const std::vector<PairStamps>& pairs, PairAudit& audit);

struct RecordedImage {
  cv::Mat pixels;      ///< CV_8UC3, or of depth CV_16UC1 or CV_32FC1 in metres
  std::string format;  ///< "png", "rgb8", …
};

/// Read the images of a pair by its number; throw Error when one cannot be used.
struct PairReader {
  std::function<RecordedImage(std::size_t pair)> color, depth;
};

/// Reads about `samples` pairs, from several places of the recording. Images that cannot be used
/// are findings.
void audit_images(const std::vector<PairStamps>& pairs, const PairReader& reader, int samples,
                  PairAudit& audit);

}  // namespace stillpoint::inspection
