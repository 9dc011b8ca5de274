// stillpoint map: what to do with a saved dense map.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "commands.hpp"
#include "dense_map/map_difference.hpp"
#include "dense_map/map_picture.hpp"
#include "dense_map/map_summary.hpp"
#include "semantic_octree/cost_map.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/point_cloud_file.hpp"

namespace stillpoint {
namespace {

using semantic_octree::floor_of;
using semantic_octree::project;
using semantic_octree::read_octree;
using semantic_octree::write_cost_map;
using semantic_octree::write_occupancy;
using semantic_octree::write_octree;
using semantic_octree::write_point_cloud;

namespace fs = std::filesystem;
using namespace dense_map;

CLI::Option* add_file(CLI::App& command, const char* name, std::string& file, const char* help) {
  return command.add_option(name, file, help)->type_name("FILE");
}

void add_map_argument(CLI::App& command, const char* name, std::string& file) {
  add_file(command, name, file, "Saved map: .ot or .bt")->required();
}

/// "1,2,3" as numbers, of which there must be so many.
std::vector<double> numbers_from(const std::string& text, const std::string& option,
                                 std::size_t least, std::size_t most) {
  std::vector<double> numbers;
  std::istringstream parts(text);
  bool good = !text.empty() && text.back() != ',';
  for (std::string part; good && std::getline(parts, part, ',');) {
    double value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    good = error == std::errc() && end == part.data() + part.size() && std::isfinite(value);
    numbers.push_back(value);
  }
  if (!good || numbers.size() < least || numbers.size() > most)
    throw Error(Fault::kUsage, "'" + text + "' should be numbers with commas between them", option);
  return numbers;
}

void add_floor(CLI::App& command, std::string& floor) {
  command
      .add_option("--floor", floor,
                  "Up direction in the map and the floor's height along it, m; what is left out is "
                  "estimated from the map, with up assumed to be near -y")
      ->type_name("X,Y,Z[,H]");
}

std::vector<double> floor_from(const std::string& text) {
  if (text.empty()) return {};
  const std::vector<double> floor = numbers_from(text, "--floor", 3, 4);
  if (!CostMapOptions::is_floor(floor))
    throw Error(Fault::kUsage, "'" + text + "' is no direction", "--floor");
  return floor;
}

void add_info(CLI::App& map) {
  struct Arguments {
    std::string file, floor;
    bool json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      map.add_subcommand("info", "Resolution, size, classes, floor and memory of a map");
  add_map_argument(*command, "map", arguments->file);
  add_floor(*command, arguments->floor);
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  command->callback([arguments] {
    const MapSummary summary =
        summarise(read_octree(arguments->file), {.floor = floor_from(arguments->floor)});
    if (arguments->json)
      std::cout << summary_json(summary).dump(2) << '\n';
    else
      std::cout << summary_table(summary, arguments->file);
  });
}

void convert(const std::string& from, const fs::path& to) {
  const std::string kind = to.extension().string();
  const std::vector<std::string> kinds = {".ot", ".bt", ".ply"};
  if (std::ranges::find(kinds, kind) == kinds.end())
    throw Error(Fault::kUsage, "'" + kind + "' is no kind of map", to.string(),
                "there are .ot (voxels with colours and classes), .bt (occupied or free) and .ply "
                "(points)");
  const SavedOctree map = read_octree(from);
  if (kind == ".ot") write_octree(*map.tree, map.classes, to);
  if (kind == ".bt") write_occupancy(*map.tree, to);
  if (kind == ".ply") write_point_cloud(*map.tree, map.classes, to);
}

void add_convert(CLI::App& map) {
  struct Arguments {
    std::string from, to;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      map.add_subcommand("convert", "Save a map as .ot, .bt or .ply, by the name of the new file");
  add_map_argument(*command, "map", arguments->from);
  add_file(*command, "-o,--output", arguments->to, "The new file")->required();
  command->callback([arguments] { convert(arguments->from, arguments->to); });
}

void add_project(CLI::App& map) {
  struct Arguments {
    std::string map, output, floor;
    CostMapOptions options;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = map.add_subcommand(
      "project", "Make the 2-D cost map of a map: where a robot may drive (PGM and YAML)");
  add_map_argument(*command, "map", arguments->map);
  add_file(*command, "-o,--output", arguments->output,
           "Name without extension; .pgm and .yaml are added; default: the map's name");
  const auto number = [&](const char* name, double& value, const char* help) {
    command->add_option(name, value, help)
        ->capture_default_str()
        ->check(CLI::Range(0.0, 10.0))
        ->type_name("NUMBER");
  };
  CostMapOptions& options = arguments->options;
  number("--from", options.from, "Height above the floor, m; what is lower is no obstacle");
  number("--to", options.to, "Height above the floor, m; what is higher is no obstacle");
  number("--robot-radius", options.robot_radius, "Inflate obstacles by this radius, m");
  add_floor(*command, arguments->floor);
  command->callback([arguments] {
    CostMapOptions chosen = arguments->options;
    require_numbers({chosen.from, chosen.to, chosen.robot_radius});
    if (chosen.from >= chosen.to) throw Error(Fault::kUsage, "--from must be lower than --to");
    chosen.floor = floor_from(arguments->floor);
    const SavedOctree saved = read_octree(arguments->map);
    const auto floor = floor_of(*saved.tree, chosen);
    if (!floor)
      throw Error(Fault::kData, "no floor is in the map", arguments->map,
                  "say where it is: --floor=X,Y,Z,HEIGHT");
    const fs::path stem = arguments->output.empty() ? fs::path(arguments->map).replace_extension()
                                                    : fs::path(arguments->output);
    write_cost_map(project(*saved.tree, *floor, chosen), stem);
  });
}

void add_diff(CLI::App& map) {
  struct Arguments {
    std::string first, second, points;
    bool json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = map.add_subcommand("diff", "Compare two maps of one world, voxel by voxel");
  add_map_argument(*command, "first", arguments->first);
  add_map_argument(*command, "second", arguments->second);
  add_file(*command, "--ply", arguments->points,
           "Write the voxels that only one has: of the first red, of the second green");
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  command->callback([arguments] {
    const MapDifference difference =
        dense_map::compare(read_octree(arguments->first), read_octree(arguments->second));
    if (!arguments->points.empty())
      write_ply(difference.points, {"both", "first", "second"}, arguments->points);
    if (arguments->json)
      std::cout << difference_json(difference).dump(2) << '\n';
    else
      std::cout << difference_table(difference, arguments->first, arguments->second);
  });
}

struct RenderArguments {
  std::string map, output, floor, eye, target, mode = "color", size = "1280x960";
  PictureOptions options;
};

cv::Size size_from(const std::string& text) {
  int width = 0, height = 0;
  char x = 0, rest = 0;
  constexpr int kLargest = 8192;
  if (std::sscanf(text.c_str(), "%d%c%d%c", &width, &x, &height, &rest) != 3 || x != 'x' ||
      std::min(width, height) < 64 || std::max(width, height) > kLargest)
    throw Error(Fault::kUsage, "'" + text + "' is no size of a picture", "--size",
                "say for example 1280x960; 64 to 8192 px");
  return {width, height};
}

void render(const RenderArguments& arguments) {
  PictureOptions options = arguments.options;
  options.size = size_from(arguments.size);
  if (arguments.mode == "class") options.mode = PictureOptions::Mode::kClass;
  require_numbers({options.azimuth, options.elevation, options.highest.value_or(0)});
  options.floor = floor_from(arguments.floor);
  if (arguments.eye.empty() != arguments.target.empty())
    throw Error(Fault::kUsage, "--eye and --look-at belong together");
  if (!arguments.eye.empty()) {
    options.eye = Eigen::Vector3d(numbers_from(arguments.eye, "--eye", 3, 3).data());
    options.target = Eigen::Vector3d(numbers_from(arguments.target, "--look-at", 3, 3).data());
  }
  if (fs::path(arguments.output).extension() != ".png")
    throw Error(Fault::kUsage, "pictures are PNG files", arguments.output, "call it .png");
  write_picture(picture_of(read_octree(arguments.map), options), arguments.output);
}

void add_render(CLI::App& map) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = map.add_subcommand("render", "Draw a map; needs no display");
  add_map_argument(*command, "map", arguments->map);
  add_file(*command, "-o,--output", arguments->output, "PNG file")->required();
  command->add_option("--mode", arguments->mode, "Colour scheme of the voxels")
      ->capture_default_str()
      ->check(CLI::IsMember({"color", "class"}))
      ->type_name("color|class");
  const auto number = [&](const char* name, double& value, double min, double max,
                          const char* help) {
    return command->add_option(name, value, help)->check(CLI::Range(min, max))->type_name("NUMBER");
  };
  PictureOptions& options = arguments->options;
  number("--azimuth", options.azimuth, -360, 360,
         "Degrees around the map; 0: from behind the first camera, 90: from its left")
      ->capture_default_str();
  number("--elevation", options.elevation, -90, 90, "Degrees above the floor; 90: from above")
      ->capture_default_str();
  command
      ->add_option("--below", options.highest,
                   "Draw only voxels below this height above the floor, m")
      ->check(CLI::Range(-100.0, 100.0))
      ->type_name("NUMBER");
  const auto point = [&](const char* name, std::string& value, const char* help) {
    command->add_option(name, value, help)->type_name("X,Y,Z");
  };
  point("--eye", arguments->eye, "Look from this point of the map, m; default: see the whole map");
  point("--look-at", arguments->target, "Look at this point of the map, m");
  add_floor(*command, arguments->floor);
  command->add_option("--size", arguments->size, "Of the picture, px")
      ->capture_default_str()
      ->type_name("WxH");
  command->callback([arguments] { render(*arguments); });
}

}  // namespace

void add_map(CLI::App& app) {
  CLI::App* command = app.add_subcommand("map", "Look at, convert and compare saved dense maps");
  command->require_subcommand(1);
  add_info(*command);
  add_convert(*command);
  add_project(*command);
  add_diff(*command);
  add_render(*command);
}

}  // namespace stillpoint
