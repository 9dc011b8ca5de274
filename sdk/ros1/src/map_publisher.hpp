// What is published from time to time, where it is subscribed: path, landmarks, dense map, octree,
// grid.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <stillpoint/support/temporary_folder.hpp>

#include "frames.hpp"
#include "session.hpp"

namespace stillpoint_ros {

/// On a thread of its own: tracking does not wait for it.
class MapPublisher {
 public:
  /// `session` and `frames` must outlive it.
  MapPublisher(ros::NodeHandle node, const Session& session, const Frames& frames,
               double period_seconds);
  ~MapPublisher();

 private:
  template <class Message>
  void publish(const ros::Publisher& publisher, Message message, const std::string& frame) const;
  template <class Step>
  void guarded(Step&& step) const;

  void publish_path() const;
  void publish_maps() const;
  void publish_dense_files() const;

  const Session& session_;
  const Frames& frames_;
  const stillpoint::TemporaryFolder folder_;  // for the files of the dense map
  ros::Publisher path_, landmarks_, dense_map_, octomap_, grid_;
  ros::CallbackQueue queue_;
  ros::WallTimer path_timer_, map_timer_;
  ros::AsyncSpinner spinner_;
};

}  // namespace stillpoint_ros
