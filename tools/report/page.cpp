#include "report/page.hpp"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "report/map_voxels.hpp"
#include "report/packing.hpp"
#include "report/page_json.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/base64.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "stillpoint/support/image_file.hpp"
#include "study/text_file.hpp"

namespace stillpoint::report {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kPlace = "<!-- data -->";
constexpr std::size_t kAllPoints = 50'000;  // of one series over all runs

/// What the page finds by its id, packed.
std::string block(const std::string& id, std::string_view bytes) {
  return "<script type=\"text/plain\" id=\"" + id + "\">" + base64(gzipped(bytes)) + "</script>\n";
}

/// Names and messages may hold what another program has written, valid UTF-8 or not.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// As JPEG, no wider than a page shows it. Empty when it cannot be read.
std::string jpeg_of(const std::filesystem::path& file) {
  constexpr int kWidth = 960, kQuality = 80;
  cv::Mat picture;
  try {
    picture = decode_image(read_image_file(file), cv::IMREAD_COLOR);
  } catch (const Error& error) {
    if (error.fault() != Fault::kData) throw;
  }
  if (picture.empty()) return {};
  if (picture.cols > kWidth)
    cv::resize(picture, picture, {kWidth, picture.rows * kWidth / picture.cols}, 0, 0,
               cv::INTER_AREA);
  const std::vector<std::uint8_t> bytes =
      encode_image(".jpg", picture, {cv::IMWRITE_JPEG_QUALITY, kQuality});
  return {bytes.begin(), bytes.end()};
}

class Blocks {
 public:
  Blocks(const ReportData& data, const std::filesystem::path& folder, const PageLimits& limits)
      : folder_(folder), limits_(limits) {
    points_ = std::clamp<std::size_t>(kAllPoints / std::max<std::size_t>(1, data.runs.size()), 150,
                                      limits.points);
  }

  std::string of(const RunData& run, std::size_t index) {
    const std::string id = std::to_string(index);
    Json json = run_json(run, points_);
    std::string text;
    add_pictures(run, id, json, text);
    add_map(run, id, json, text);
    add_replay(run, id, json, text);
    return block("run-" + id, text_of(json)) + text;
  }

 private:
  void add_pictures(const RunData& run, const std::string& id, Json& json, std::string& text) {
    json["pictures"] = Json::array();
    for (std::size_t i = 0; i < run.pictures.size(); ++i) {
      const Picture& picture = run.pictures[i];
      if (pictures_ >= limits_.picture_bytes) {
        json["left_out"].push_back("Pictures: the page has room for no more; 'stillpoint report " +
                                   run.folder.string() + "' shows them.");
        return;
      }
      const std::string jpeg = jpeg_of(picture.file);
      if (jpeg.empty()) continue;
      pictures_ += jpeg.size();
      const std::string name = "picture-" + id + "-" + std::to_string(i);
      text += "<script type=\"text/plain\" id=\"" + name + "\">" + base64(jpeg) + "</script>\n";
      json["pictures"].push_back({{"id", name},
                                  {"frame", picture.frame},
                                  {"why", picture.why},
                                  {"state", picture.state},
                                  {"recorded", picture.recorded}});
    }
  }

  void add_map(const RunData& run, const std::string& id, Json& json, std::string& text) {
    if (run.octree.empty()) return;
    if (maps_ >= limits_.map_bytes) {
      json["left_out"].push_back("Dense map: the page has room for no more; 'stillpoint report " +
                                 run.folder.string() + "' shows it.");
      return;
    }
    try {
      const MapVoxels voxels = read_voxels(run.octree, limits_.voxels);
      if (voxels.size() == 0) return;
      const std::string packed = block("map-" + id, map_bytes(voxels));
      maps_ += packed.size();
      text += packed;
      json["map"] = map_json(voxels);
      json["map"]["id"] = "map-" + id;
    } catch (const Error& error) {
      json["notes"].push_back(error.what());
    }
  }

  void add_replay(const RunData& run, const std::string& id, Json& json, std::string& text) {
    if (run.live_view.empty()) return;
    const std::size_t room = limits_.replay_bytes - std::min(limits_.replay_bytes, replays_);
    // Most of it are pictures in base64: packed and in base64 again, it is about as large.
    std::error_code unreadable;
    std::string packed;
    if (std::filesystem::file_size(run.live_view, unreadable) < 2 * room)
      packed = block("replay-" + id, study::read_text(run.live_view));
    if (packed.empty() || packed.size() > room) {
      json["replay"]["file"] = std::filesystem::proximate(run.live_view, folder_).string();
      return;
    }
    replays_ += packed.size();
    text += packed;
    json["replay"]["id"] = "replay-" + id;
  }

  const std::filesystem::path& folder_;
  const PageLimits& limits_;
  std::size_t points_ = 0, pictures_ = 0, maps_ = 0, replays_ = 0;
};

}  // namespace

std::string filled_page(const std::filesystem::path& page, const ReportData& data,
                        const std::filesystem::path& folder, const std::string& written_by,
                        const PageLimits& limits) {
  std::string text = study::read_text(page);
  const std::size_t place = text.find(kPlace);
  if (place == std::string::npos)
    throw Error(Fault::kUsage, "this build of Stillpoint has no page for reports", page.string(),
                "build it with npm and esbuild installed and STILLPOINT_WITH_PAGES=ON");
  std::string blocks = block("report", text_of(report_json(data, written_by)));
  Blocks of_runs(data, folder, limits);
  for (std::size_t i = 0; i < data.runs.size(); ++i) blocks += of_runs.of(data.runs[i], i);
  return text.replace(place, kPlace.size(), blocks);
}

}  // namespace stillpoint::report
