#include "output_files/keyframes_output.hpp"

#include "stillpoint/support/atomic_file.hpp"
#include "stillpoint/support/tum_pose.hpp"

namespace stillpoint::output_files {

void KeyFramesOutput::finish(const RunSummary& summary) {
  AtomicFile file(path_);
  file.stream() << "# time tx ty tz qx qy qz qw\n";
  for (KeyFrameId id = 0; id < summary.map.keyframe_id_end(); ++id)
    if (const KeyFrame* keyframe = summary.map.keyframe(id))
      write_tum_pose(file.stream(), keyframe->time, keyframe->world_from_camera);
  file.commit();
}

}  // namespace stillpoint::output_files
