#include "importing/bonn.hpp"

#include <string>

#include "importing/listed_recording.hpp"

namespace stillpoint::importing {

bool is_bonn(const std::filesystem::path& recording) {
  std::filesystem::path folder = std::filesystem::absolute(recording).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  return folder.filename().string().starts_with("rgbd_bonn") &&
         std::filesystem::exists(folder / "rgb.txt") &&
         std::filesystem::exists(folder / "depth.txt");
}

std::unique_ptr<ForeignRecording> open_bonn(const std::filesystem::path& recording,
                                            const ImportOptions& options) {
  ListedRecording::Lists lists;
  lists.color = tum_recording::read_image_list(recording / "rgb.txt", lists.notes);
  lists.depth = tum_recording::read_image_list(recording / "depth.txt", lists.notes);
  const std::filesystem::path truth = recording / "groundtruth.txt";
  if (std::filesystem::exists(truth)) {
    for (const tum_recording::ListLine& line : tum_recording::read_list_lines(truth))
      lists.truth.push_back(tum_pose_of(line, truth));
    lists.notes.emplace_back(
        "the ground truth is that of the markers on the camera, 2 cm from its centre, as "
        "published");
  }
  return std::make_unique<ListedRecording>(std::move(lists), options.camera.value(),
                                           options.most_frames);
}

}  // namespace stillpoint::importing
