// One file of a folder that another program wrote; the others are as they should be.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fuzz/fuzz_target.hpp"
#include "importing/euroc.hpp"
#include "importing/icl_nuim_raw.hpp"
#include "ros2_messages/cost_map_file.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "support/recording_writer.hpp"
#include "tum_recording/recording.hpp"

namespace stillpoint::testing {
namespace {

using importing::ImportOptions;

const std::vector<std::string> kNumbers = {"nan", "-inf", "1e400", "1e308", "-", "[", "]",
                                           ",",   ":",    "\n",    "\t",    "#", "{", "}"};

/// `others`: name and content of each. `read` gets the folder.
FuzzTarget one_file(const std::string& name, const std::string& seed,
                    const std::vector<std::pair<std::string, std::string>>& others,
                    void (*read)(const fs::path&)) {
  const auto folder = std::make_shared<TemporaryFolder>();
  for (const auto& [other, text] : others) folder->write(other, text);
  folder->write(name, "");
  return {.seeds = {bytes_of_text(seed)},
          .parse =
              [=](const fs::path& file) {
                fs::copy_file(file, folder->path() / name, fs::copy_options::overwrite_existing);
                read(folder->path());
              },
          .words = kNumbers};
}

std::string image(int type) {
  const std::vector<std::uint8_t> bytes =
      encode_image(".png", cv::Mat(48, 64, type, cv::Scalar::all(80)));
  return {bytes.begin(), bytes.end()};
}

constexpr const char* kImages = "#timestamp [ns],filename\n1403636580838555648,a.png\n";
constexpr const char* kSensor =
    "sensor_type: camera\nT_BS:\n  data: [0, -1, 0, 0.1, 1, 0, 0, 0.2, 0, 0, 1, 0.3, 0, 0, 0, 1]\n"
    "resolution: [64, 48]\nintrinsics: [50, 50, 32, 24]\ndistortion_coefficients: [0, 0, 0, 0]\n";
constexpr const char* kTruth =
    "#timestamp, p\n1403636580838555648,1,2,3,1,0,0,0,0,0,0\n1403636580938555648,1,2,4,1,0,0,0\n";

FuzzTarget euroc(const std::string& name, const std::string& seed) {
  return one_file(name, seed,
                  {{"mav0/cam0/data.csv", kImages},
                   {"mav0/depth0/data.csv", kImages},
                   {"mav0/cam0/data/a.png", image(CV_8UC3)},
                   {"mav0/depth0/data/a.png", image(CV_16UC1)},
                   {"mav0/cam0/sensor.yaml", kSensor},
                   {"mav0/state_groundtruth_estimate0/data.csv", kTruth}},
                  [](const fs::path& folder) { importing::open_euroc(folder, {})->truth(); });
}
FuzzTarget euroc_list() { return euroc("mav0/cam0/data.csv", kImages); }
FuzzTarget euroc_sensor() { return euroc("mav0/cam0/sensor.yaml", kSensor); }
FuzzTarget euroc_truth() { return euroc("mav0/state_groundtruth_estimate0/data.csv", kTruth); }

constexpr const char* kView =
    "cam_pos = [149.376, 451.41, -285.9]';\ncam_dir = [0.9, -0.3, 0.1]';\ncam_up = [0, 1, 0]';\n";
constexpr const char* kDistances = "90.5 1e2 3.25 4\n5 6 7 8\n";

FuzzTarget icl_nuim(const std::string& name, const std::string& seed) {
  return one_file(name, seed,
                  {{"scene_000.png", "an image is not read"},
                   {"scene_000.depth", kDistances},
                   {"scene_000.txt", kView}},
                  [](const fs::path& folder) {
                    ImportOptions options;
                    options.camera = CameraModel{
                        .width = 4, .height = 2, .fx = 4, .fy = 4, .cx = 1.5, .cy = 0.5};
                    importing::open_icl_nuim_raw(folder, options)->read(0);
                  });
}
FuzzTarget icl_nuim_view() { return icl_nuim("scene_000.txt", kView); }
FuzzTarget icl_nuim_depth() { return icl_nuim("scene_000.depth", kDistances); }

FuzzTarget associations() {
  return one_file("associations.txt",
                  "1305031102.175304 rgb/a.png 1305031102.160407 depth/a.png\n"
                  "1305031102.211214 depth/b.png 1305031102.226738 rgb/b.png\n",
                  {}, [](const fs::path& folder) { tum_recording::open_recording(folder); });
}

FuzzTarget cost_map() {
  return one_file("map.yaml",
                  "image: \"map.pgm\"\nresolution: 0.05\norigin: [-1.5, -2, 0]\n"
                  "world_from_map: [0, 0, 0, 0.5, 0.5, -0.5, 0.5]\n",
                  {{"map.pgm", "P5\n2 2\n255\nabcd"}},
                  [](const fs::path& folder) { ros2_messages::read_cost_map(folder); });
}

}  // namespace

std::vector<NamedFuzzTarget> folder_targets() {
  return {{"EurocList", euroc_list},        {"EurocSensor", euroc_sensor},
          {"EurocTruth", euroc_truth},      {"IclNuimView", icl_nuim_view},
          {"IclNuimDepth", icl_nuim_depth}, {"CostMap", cost_map},
          {"Associations", associations}};
}

}  // namespace stillpoint::testing
