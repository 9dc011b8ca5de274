#include "parameters.hpp"

#include <algorithm>
#include <stillpoint/error.hpp>
#include <stillpoint/support/did_you_mean.hpp>
#include <utility>

namespace stillpoint_ros {
namespace {

using stillpoint::Error;
using stillpoint::Fault;

constexpr const char* kMapFile = "map_file";

class Reader {
 public:
  explicit Reader(const ros::NodeHandle& node) : node_(node) {}

  template <class Value>
  void read(const std::string& name, Value& value) {
    names_.push_back(name);
    if (node_.hasParam(name) && !node_.getParam(name, value))
      throw Error(Fault::kUsage, "the parameter has another type than it must have",
                  node_.resolveName(name), "README.md lists the parameters");
  }

  void refuse_others() {
    names_.push_back(kMapFile);
    std::vector<std::string> given;
    node_.getParamNames(given);
    const std::string prefix = node_.getNamespace() + '/';
    for (const std::string& full : given) {
      if (full.compare(0, prefix.size(), prefix) != 0) continue;
      const std::string name = full.substr(prefix.size());
      if (std::find(names_.begin(), names_.end(), name) == names_.end())
        throw Error(Fault::kUsage,
                    "there is no such parameter" + stillpoint::did_you_mean(name, names_), full);
    }
  }

 private:
  const ros::NodeHandle& node_;
  std::vector<std::string> names_;
};

void require(bool condition, const ros::NodeHandle& node, const std::string& name,
             const std::string& range) {
  if (!condition) throw Error(Fault::kUsage, "must be " + range, node.resolveName(name));
}

void check(const Parameters& of, const ros::NodeHandle& node) {
  require(!of.map_frame.empty(), node, "map_frame", "the name of a frame");
  require(of.odom_frame.empty() || !of.base_frame.empty(), node, "base_frame",
          "given with odom_frame");
  require(of.max_difference >= 0 && of.max_difference <= 1, node, "max_difference",
          "from 0 to 1 s");
  require(of.queue_size >= 1, node, "queue_size", "1 or more");
  require(of.depth_factor > 0, node, "depth_factor", "larger than 0");
  require(of.min_depth >= 0 && of.min_depth < of.max_depth, node, "min_depth",
          "0 or more, and less than max_depth");
  for (const auto& [name, noise] :
       {std::pair{"depth_noise", of.depth_noise}, {"surface_noise", of.surface_noise}})
    require(noise >= 1e-6 && noise <= 100, node, name, "from 1e-6 to 100 m");
  require(of.map_period >= 0.1, node, "map_period", "0.1 s or more");
}

}  // namespace

Parameters read_parameters(const ros::NodeHandle& node) {
  Parameters p;
  Reader reader(node);
  reader.read("pipeline", p.session.pipeline);
  reader.read("set", p.session.set);
  reader.read("map_frame", p.map_frame);
  reader.read("odom_frame", p.odom_frame);
  reader.read("base_frame", p.base_frame);
  reader.read("camera_frame", p.camera_frame);
  reader.read("approximate", p.approximate);
  reader.read("max_difference", p.max_difference);
  reader.read("queue_size", p.queue_size);
  reader.read("rectified", p.rectified);
  reader.read("depth_factor", p.depth_factor);
  reader.read("min_depth", p.min_depth);
  reader.read("max_depth", p.max_depth);
  reader.read("depth_noise", p.depth_noise);
  reader.read("surface_noise", p.surface_noise);
  reader.read("map_period", p.map_period);
  reader.read("load_map", p.load_map);
  reader.read("localise_only", p.session.localise_only);
  reader.refuse_others();
  check(p, node);
  return p;
}

std::filesystem::path map_file(const ros::NodeHandle& node) {
  return std::filesystem::absolute(node.param<std::string>(kMapFile, "stillpoint.map"));
}

}  // namespace stillpoint_ros
