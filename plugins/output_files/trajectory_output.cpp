#include "output_files/trajectory_output.hpp"

#include "stillpoint/support/atomic_file.hpp"
#include "stillpoint/support/trajectory.hpp"
#include "stillpoint/support/tum_pose.hpp"

namespace stillpoint::output_files {

void TrajectoryOutput::finish(const RunSummary& summary) {
  AtomicFile file(path_);
  file.stream() << "# time tx ty tz qx qy qz qw\n";
  for (const TrackedPose& pose : summary.poses)
    if (const auto in_world = world_from_camera(summary.map, pose))
      write_tum_pose(file.stream(), pose.time, *in_world);
  file.commit();
}

}  // namespace stillpoint::output_files
