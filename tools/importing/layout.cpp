#include "importing/layout.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "importing/bonn.hpp"
#include "importing/euroc.hpp"
#include "importing/icl_nuim.hpp"
#include "importing/icl_nuim_raw.hpp"
#include "importing/scannet.hpp"
#include "importing/seven_scenes.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint::importing {
namespace {

constexpr std::array<Layout, 6> kLayouts = {{
    {"7-scenes", "7-Scenes", "frame-000000.color.png, .depth.png and .pose.txt", "seven_scenes",
     is_seven_scenes, open_seven_scenes},
    {"bonn", "Bonn RGB-D Dynamic", "a folder rgbd_bonn_… with rgb.txt and depth.txt", "bonn",
     is_bonn, open_bonn},
    {"euroc", "EuRoC with depth", "mav0/cam0/data.csv and mav0/depth0", nullptr, is_euroc,
     open_euroc},
    {"icl-nuim", "ICL-NUIM", "associations.txt with numbered images, and *.gt.freiburg", "icl_nuim",
     is_icl_nuim, open_icl_nuim},
    {"icl-nuim-raw", "ICL-NUIM of POV-Ray", "scene_00_0000.png, .depth and .txt", "icl_nuim",
     is_icl_nuim_raw, open_icl_nuim_raw},
    {"scannet", "ScanNet", "a .sens file", nullptr, is_scannet, open_scannet},
}};

std::vector<std::string> layout_names() {
  std::vector<std::string> names;
  for (const Layout& layout : kLayouts) names.emplace_back(layout.name);
  return names;
}

std::string all_signs() {
  std::vector<std::string> lines;
  for (const Layout& layout : kLayouts)
    lines.push_back(std::string(layout.signs) + " (" + layout.name + ")");
  return join(lines, "; ");
}

const Layout* recognised(const std::filesystem::path& recording) {
  const auto found =
      std::ranges::find_if(kLayouts, [&](const Layout& l) { return l.recognises(recording); });
  return found == kLayouts.end() ? nullptr : &*found;
}

/// The first by name of the folders in `folder` that is a recording; empty: none.
std::filesystem::path recording_within(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> folders;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.is_directory(error)) folders.push_back(entry.path());
  std::ranges::sort(folders);
  const auto found = std::ranges::find_if(folders, [](const auto& f) { return recognised(f); });
  return found == folders.end() ? std::filesystem::path() : *found;
}

}  // namespace

std::span<const Layout> layouts() { return kLayouts; }

const Layout& layout_named(const std::string& name) {
  const auto found = std::ranges::find(kLayouts, name, &Layout::name);
  if (found != kLayouts.end()) return *found;
  const std::string suggestion = did_you_mean(name, layout_names());
  throw Error(Fault::kUsage, "no layout '" + name + "'" + suggestion, "--layout",
              suggestion.empty() ? "there are: " + join(layout_names()) : "");
}

const Layout& layout_of(const std::filesystem::path& recording) {
  std::error_code error;
  const bool there = std::filesystem::exists(recording, error);
  if (there && std::filesystem::is_directory(recording, error))
    std::filesystem::directory_iterator(recording, error);  // may be forbidden
  if (!there || error)
    throw Error(Fault::kData, error ? error.message() : "no such file or folder",
                recording.string());
  if (const Layout* layout = recognised(recording)) return *layout;
  if (std::filesystem::exists(recording / "rgb.txt") &&
      std::filesystem::exists(recording / "depth.txt"))
    throw Error(Fault::kUsage, "is in the layout of the TUM benchmark already", recording.string(),
                "give it to 'run --dataset' as it is");
  if (const auto within = recording_within(recording); !within.empty())
    throw Error(Fault::kData, "holds recordings, but is none", recording.string(),
                "give one of them, such as " + within.string());
  throw Error(Fault::kData, "the layout is not recognised", recording.string(),
              "looked for " + all_signs());
}

}  // namespace stillpoint::importing
