#include <algorithm>
#include <sstream>

#include "inspection/bag_audit.hpp"
#include "inspection/number_text.hpp"
#include "inspection/pair_report.hpp"
#include "inspection/report_text.hpp"

namespace stillpoint::inspection {
namespace {

using BagJson = nlohmann::ordered_json;

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, text.size()), ' ');
}

std::string size_on_disk(std::uintmax_t bytes) {
  return fixed(static_cast<double>(bytes) / 1e6, 1) + " MB";
}

std::string rate_text(const StreamAudit& stream) {
  return stream.interval > 0 ? fixed(1 / stream.interval, 1) + " Hz" : "";
}

void print_topics(std::ostream& out, const BagAudit& audit) {
  std::size_t name_width = 0, type_width = 0;
  for (const TopicAudit& topic : audit.topics) {
    name_width = std::max(name_width, topic.topic.name.size());
    type_width = std::max(type_width, topic.topic.type.size());
  }
  out << "  topics\n";
  for (const TopicAudit& topic : audit.topics) {
    std::string line = "    " + padded(topic.topic.name, name_width) + "  " +
                       padded(topic.topic.type, type_width) + "  " +
                       right(std::to_string(topic.messages.images), 7) +
                       right(rate_text(topic.messages), 11);
    if (!topic.images.empty()) line += "  " + topic.images;
    out << line << '\n';
  }
}

std::string camera_text(const CameraModel& camera) {
  std::string text = camera.name + ": " + std::to_string(camera.width) + " x " +
                     std::to_string(camera.height) + ", fx " + fixed(camera.fx, 1) + ", fy " +
                     fixed(camera.fy, 1) + ", cx " + fixed(camera.cx, 1) + ", cy " +
                     fixed(camera.cy, 1);
  if (camera.distortion.empty()) return text + ", no distortion";
  text += ", distortion";
  for (const double k : camera.distortion) text += " " + fixed(k, 4);
  return text;
}

std::string depth_camera_text(const BagAudit& audit) {
  const double distance = audit.color_from_depth->translation().norm();
  return camera_text(*audit.depth_camera) + "; " + fixed(1e3 * distance, 1) +
         " mm beside, registered to colour";
}

BagJson topic_json(const TopicAudit& topic) {
  return {{"name", topic.topic.name},
          {"type", topic.topic.type},
          {"encoding", topic.topic.encoding},
          {"messages", topic.messages.images},
          {"begin", topic.messages.begin},
          {"duration", topic.messages.duration},
          {"interval", topic.messages.interval},
          {"images", topic.images}};
}

BagJson camera_json(const CameraModel& camera) {
  return {{"name", camera.name},     {"width", camera.width},
          {"height", camera.height}, {"fx", camera.fx},
          {"fy", camera.fy},         {"cx", camera.cx},
          {"cy", camera.cy},         {"distortion", camera.distortion}};
}

}  // namespace

std::string report_table(const BagAudit& audit) {
  std::ostringstream out;
  out << audit.path.string() << '\n';
  row(out, "format", audit.format + ", " + size_on_disk(audit.bytes));
  print_topics(out, audit);
  if (audit.choice)
    print_streams(out, audit, audit.choice->color.name + ": ", audit.choice->depth.name + ": ",
                  "by time stamp");
  if (audit.camera) row(out, "camera", camera_text(*audit.camera));
  if (audit.color_from_depth) row(out, "depth camera", depth_camera_text(audit));
  if (audit.choice) print_images(out, audit);
  print_depth(out, audit);
  print_warnings(out, audit);
  return out.str();
}

BagJson report_json(const BagAudit& audit) {
  BagJson topics = BagJson::array();
  for (const TopicAudit& topic : audit.topics) topics.push_back(topic_json(topic));
  BagJson json = {{"bag", audit.path.string()},
                  {"format", audit.format},
                  {"bytes", audit.bytes},
                  {"topics", topics}};
  if (audit.choice) {
    json.update(pair_json(audit));
    json["color"]["topic"] = audit.choice->color.name;
    json["depth"]["topic"] = audit.choice->depth.name;
    json["registered"] = audit.choice->registered();
  }
  json["camera"] = audit.camera ? camera_json(*audit.camera) : BagJson(nullptr);
  if (audit.depth_camera) json["depth_camera"] = camera_json(*audit.depth_camera);
  json["warnings"] = audit.warnings;
  return json;
}

}  // namespace stillpoint::inspection
