#include "importing/layout.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "importing/bonn.hpp"
#include "importing/euroc.hpp"
#include "importing/icl_nuim.hpp"
#include "importing/scannet.hpp"
#include "importing/seven_scenes.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint::importing {
namespace {

constexpr std::array<Layout, 5> kLayouts = {{
    {"7-scenes", "7-Scenes", "frame-000000.color.png, .depth.png and .pose.txt", "seven_scenes",
     is_seven_scenes, open_seven_scenes},
    {"bonn", "Bonn RGB-D Dynamic", "a folder rgbd_bonn_… with rgb.txt and depth.txt", "bonn",
     is_bonn, open_bonn},
    {"euroc", "EuRoC with depth", "mav0/cam0/data.csv and mav0/depth0", nullptr, is_euroc,
     open_euroc},
    {"icl-nuim", "ICL-NUIM", "associations.txt with numbered images, and *.gt.freiburg", "icl_nuim",
     is_icl_nuim, open_icl_nuim},
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
  if (!std::filesystem::exists(recording))
    throw Error(Fault::kData, "no such file or folder", recording.string());
  for (const Layout& layout : kLayouts)
    if (layout.is_there(recording)) return layout;
  if (std::filesystem::exists(recording / "rgb.txt") &&
      std::filesystem::exists(recording / "depth.txt"))
    throw Error(Fault::kUsage, "is in the layout of the TUM benchmark already", recording.string(),
                "give it to 'run --dataset' as it is");
  throw Error(Fault::kData, "the layout is not recognised", recording.string(),
              "looked for " + all_signs());
}

}  // namespace stillpoint::importing
