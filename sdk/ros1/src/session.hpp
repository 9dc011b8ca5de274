// The engine behind plain types: it needs C++20, with which the headers of ROS 1 in Debian cannot
// be compiled. All other files are C++17.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <stillpoint/contracts/labelled_point.hpp>
#include <stillpoint/error.hpp>
#include <stillpoint/pose_math.hpp>
#include <string>
#include <vector>

namespace stillpoint {
class Engine;
class Rectifier;
class SparseMap;
}  // namespace stillpoint

namespace stillpoint_ros {

struct SessionOptions {
  std::string pipeline = "stillpoint";           ///< a file, or a name from configs/pipelines
  std::vector<std::string> set;                  ///< changes of it, `key.sub=value`
  bool localise_only = false;                    ///< a loaded map stays as it is
  std::function<void(const std::string&)> warn;  ///< called from any thread
};

/// Members as those of stillpoint::CameraModel.
struct SensorCamera {
  int width = 0, height = 0;               ///< px
  double fx = 0, fy = 0, cx = 0, cy = 0;   ///< px
  std::vector<double> distortion;          ///< k1, k2, p1, p2[, k3]; empty: none
  double depth_factor = 1000;              ///< value of one metre in depth images with 16 bits
  double min_depth = 0.3, max_depth = 10;  ///< metres
  double depth_noise = 0.02, surface_noise = 0.002;  ///< metres at 1 m, as in Camera
};

struct SensorImages {
  double time = 0;  ///< seconds, of the colour image
  cv::Mat bgr;      ///< CV_8UC3
  cv::Mat depth;    ///< CV_16UC1, or CV_32FC1 in metres; registered to bgr
};

struct TrackedFrame {
  enum class State { kWaiting, kTracking, kLost } state = State::kWaiting;
  std::uint32_t index = 0;
  stillpoint::Pose world_from_camera = stillpoint::Pose::Identity();  ///< while tracking
  std::optional<stillpoint::Matrix6d> covariance;  ///< as stillpoint::PoseUncertainty has it
  bool poorly_constrained = false;
  int inliers = 0;
  std::size_t keyframes = 0, landmarks = 0;  ///< of the map
  int loops_closed = 0;
};

/// One engine after another. Calls from any thread; one waits for the other, at most for a frame.
/// All throw stillpoint::Error.
class Session {
 public:
  /// `map_file` empty: the first frame begins a map.
  Session(SessionOptions options, const std::filesystem::path& map_file);

  /// Nothing for a frame that is not newer than the last. The camera is that of the first frame
  /// until a map is loaded or the session reset; of another one with the same size a warning tells.
  ///
  /// Throws for a camera that is none or of another size than the one in use, and when images do
  /// not fit it; or when a stage has failed, now or before: no pose follows then until a map is
  /// loaded or the session reset, but maps can be read and saved.
  std::optional<TrackedFrame> process(const SensorImages& images, const SensorCamera& camera);

  /// These say what they did. When one throws, all is as before.
  std::string save_map(const std::filesystem::path& file) const;
  std::string load_map(const std::filesystem::path& file);
  std::string reset();

  std::vector<stillpoint::StampedPose> trajectory() const;
  std::vector<Eigen::Vector3f> landmarks() const;  ///< metres, in the world
  std::vector<stillpoint::LabelledPoint> dense_map() const;
  /// As Engine::save_dense_map.
  bool save_dense_map(const std::filesystem::path& directory) const;

 private:
  void begin(stillpoint::SparseMap known_map);
  void take_camera(const SensorCamera& camera);  // under the lock
  std::shared_ptr<const stillpoint::Engine> engine() const;

  const SessionOptions options_;
  mutable std::mutex mutex_;
  SensorCamera camera_;
  std::shared_ptr<const stillpoint::Rectifier> rectifier_;  // of the camera; null before the first
  std::shared_ptr<stillpoint::Engine> engine_;
  std::optional<double> last_time_;  // seconds, of the last frame
};

}  // namespace stillpoint_ros
