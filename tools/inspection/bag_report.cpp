#include <algorithm>
#include <sstream>

#include "inspection/bag_audit.hpp"
#include "inspection/number_text.hpp"
#include "inspection/report_text.hpp"

namespace stillpoint::inspection {
namespace {

using BagJson = nlohmann::ordered_json;

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, text.size()), ' ');
}

std::string right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
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

void print_choice(std::ostream& out, const BagAudit& audit) {
  const double start = audit.color.begin;
  row(out, "colour", audit.choice->color.name + ": " + stream_text(audit.color, start));
  row(out, "depth", audit.choice->depth.name + ": " + stream_text(audit.depth, start));
  row(out, "pairs", stream_text(audit.pairs, start) + "; by time stamp");
  row(out, "unpaired",
      std::to_string(audit.color.images - audit.pairs.images) + " colour, " +
          std::to_string(audit.depth.images - audit.pairs.images) + " depth");
  row(out, "stamps of a pair",
      "differ by " + milliseconds(audit.mean_difference, 1) + " on average, " +
          milliseconds(audit.max_difference, 1) + " at most");
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

BagJson gaps_json(const StreamAudit& stream) {
  BagJson gaps = BagJson::array();
  for (const Gap& gap : stream.gaps) gaps.push_back({{"begin", gap.begin}, {"length", gap.length}});
  return gaps;
}

BagJson image_stream_json(const std::string& topic, const StreamAudit& stream) {
  return {{"topic", topic},
          {"images", stream.images},
          {"begin", stream.begin},
          {"duration", stream.duration},
          {"interval", stream.interval},
          {"gaps", gaps_json(stream)}};
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
  if (audit.choice) print_choice(out, audit);
  if (audit.camera) row(out, "camera", camera_text(*audit.camera));
  for (const std::string& warning : audit.warnings) out << "warning: " << warning << '\n';
  if (audit.warnings.empty()) out << "No problems found.\n";
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
    json["color"] = image_stream_json(audit.choice->color.name, audit.color);
    json["depth"] = image_stream_json(audit.choice->depth.name, audit.depth);
    json["pairs"] = audit.pairs.images;
    json["mean_difference"] = audit.mean_difference;
    json["max_difference"] = audit.max_difference;
    json["registered"] = audit.choice->registered();
  }
  json["camera"] = audit.camera ? camera_json(*audit.camera) : BagJson(nullptr);
  json["warnings"] = audit.warnings;
  return json;
}

}  // namespace stillpoint::inspection
