#include "importing/icl_nuim.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "importing/images.hpp"
#include "importing/listed_recording.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::importing {
namespace {

using tum_recording::ListLine;
using tum_recording::StampedImage;

double icl_time(const ListLine& line, std::size_t column, const std::filesystem::path& file) {
  return tum_recording::stamp_of(line, column, file) / kIclNuimRate;
}

std::filesystem::path truth_of(const std::filesystem::path& folder) {
  for (const std::string& name : file_names(folder))
    if (name.ends_with(".gt.freiburg")) return folder / name;
  return {};
}

void read_icl_truth(const std::filesystem::path& file, ListedRecording::Lists& lists) {
  for (const ListLine& line : tum_recording::read_list_lines(file)) {
    StampedPose pose = tum_pose_of(line, file);
    pose.time /= kIclNuimRate;
    pose.world_from_camera = mirrored_in_y(pose.world_from_camera);
    lists.truth.push_back(pose);
  }
}

}  // namespace

Pose mirrored_in_y(const Pose& pose) {
  const Eigen::DiagonalMatrix<double, 3> flip(1, -1, 1);
  Pose result = Pose::Identity();
  result.linear() = flip * pose.linear() * flip;
  result.translation() = flip * pose.translation();
  return result;
}

bool is_icl_nuim(const std::filesystem::path& recording) {
  const std::filesystem::path associations = recording / "associations.txt";
  if (!std::filesystem::is_regular_file(associations) ||
      std::filesystem::exists(recording / "rgb.txt"))
    return false;
  const auto lines = tum_recording::read_list_lines(associations);
  return !lines.empty() && std::ranges::all_of(lines.front().columns[0], [](unsigned char c) {
    return std::isdigit(c) != 0;
  });
}

std::unique_ptr<ForeignRecording> open_icl_nuim(const std::filesystem::path& recording,
                                                const ImportOptions& options) {
  const std::filesystem::path file = recording / "associations.txt";
  ListedRecording::Lists lists;
  for (const ListLine& line : tum_recording::read_list_lines(file)) {
    if (line.columns.size() < 4)
      throw Error(Fault::kData, "found " + std::to_string(line.columns.size()) + " columns",
                  file.string() + ":" + std::to_string(line.number),
                  "expected number and file of the depth image, then of the colour image");
    StampedImage first{icl_time(line, 0, file), recording / line.columns[1]};
    StampedImage second{icl_time(line, 2, file), recording / line.columns[3]};
    if (line.columns[1].starts_with("rgb")) std::swap(first, second);
    lists.depth.push_back(std::move(first));
    lists.color.push_back(std::move(second));
  }
  if (lists.color.empty()) throw Error(Fault::kData, "lists no images", file.string());
  if (const std::filesystem::path truth = truth_of(recording); !truth.empty())
    read_icl_truth(truth, lists);
  else
    lists.notes.emplace_back("there is no *.gt.freiburg beside the images, so no ground truth");
  return std::make_unique<ListedRecording>(std::move(lists), options.camera.value(),
                                           options.most_frames);
}

}  // namespace stillpoint::importing
