#include "output_files/trajectory_output.hpp"

#include "output_files/tum_pose.hpp"
#include "stillpoint/atomic_file.hpp"

namespace stillpoint {

void TrajectoryOutput::finish(const RunSummary& summary) {
  AtomicFile file(path_);
  file.stream() << "# time tx ty tz qx qy qz qw\n";
  for (const TrackedPose& pose : summary.poses) {
    if (pose.state != TrackState::kTracking) continue;
    if (pose.reference >= summary.map.keyframe_id_end()) continue;
    write_tum_pose(file.stream(), pose.time,
                   summary.map.world_from_keyframe(pose.reference) * pose.reference_from_camera);
  }
  file.commit();
}

}  // namespace stillpoint
