#include "people/plans.hpp"

namespace stillpoint::people {
namespace {

/// Rows of `width` numbers, the first of which grows.
bool is_timetable(const std::vector<double>& numbers, std::size_t width) {
  if (numbers.empty() || numbers.size() % width != 0) return false;
  for (std::size_t i = width; i < numbers.size(); i += width)
    if (numbers[i] <= numbers[i - width]) return false;
  return true;
}

}  // namespace

void PersonPlan::visit(OptionVisitor& v) {
  v.choice("clothes", clothes,
           {{"any", Clothes::kAny}, {"dark", Clothes::kDark}, {"bright", Clothes::kBright}},
           {.help = "which people may be drawn"});
  v("walk", walk,
    {.help = "time (s), x (m to the right of the first camera), y (m ahead of it), time, x, y, …",
     .required = true});
  v("again", again, {.help = "the walk begins anew when it is over"});
  v("sits", sits, {.unit = "s", .help = "from, to, from, to, …"});
  v("height", height,
    {.min = 0.2, .max = 2.3, .unit = "m", .help = "of what the photograph shows"});
  v("elevation", elevation,
    {.min = 0, .max = 3, .unit = "m", .help = "of the photograph's lower end above the floor"});
  v("photo", photo,
    {.help = "this person; the mask is beside it, as NAME_gt.png", .is_path = true});
  v("part", part, {.unit = "px", .help = "x, y, width, height of the photograph; empty: all"});
  v.require(is_timetable(walk, 3), "walk takes time, x, y, …, and times that grow");
  v.require(sits.size() % 2 == 0, "sits takes pairs from, to");
  v.require(part.empty() || part.size() == 4, "part takes x, y, width, height");
}

void ThingPlan::visit(OptionVisitor& v) {
  v("size", size, {.unit = "m", .help = "across, along, up"});
  v("path", path,
    {.help = "time (s), x, y, z (m, of its foot above the floor), …", .required = true});
  v("turn", turn, {.unit = "degrees", .help = "about the vertical"});
  v.require(size.size() == 3, "size takes three numbers");
  v.require(is_timetable(path, 4), "path takes time, x, y, z, …, and times that grow");
}

void BasePlan::visit(OptionVisitor& v) {
  v("folder", folder,
    {.help = "recording with associations.txt and groundtruth.txt",
     .required = true,
     .is_path = true});
  v("camera", camera, {.help = "camera file; empty: camera.yaml in the folder", .is_path = true});
  v("floor", floor, {.unit = "m", .help = "height of the floor in the world of the ground truth"});
  v("blur", blur, {.min = 0, .max = 5, .unit = "px", .help = "standard deviation: its sharpness"});
  v("exposure", exposure, {.min = 0, .max = 0.1, .unit = "s", .help = "of a colour image"});
  v("desk", desk,
    {.unit = "m",
     .help = "lowest, highest: what lies between is labelled a table where there are no labels"});
  v.require(desk.empty() || desk.size() == 2, "desk takes two heights");
}

void RecordingPlan::visit(OptionVisitor& v) {
  v("name", name, {.help = "its folder", .required = true});
  v("base", base, {.help = "one of the bases", .required = true});
  v("seed", seed, {.min = 0, .help = "of who comes and of the sensor's noise"});
  v("first", first, {.min = 0, .help = "pair of the base"});
  v("count", count, {.min = 0, .help = "pairs; 0: to the end"});
  v("lower", lower, {.unit = "m", .help = "by which people stand below the floor of the base"});
  v("people", people, {.help = "who is there"});
  v("things", things, {.help = "what is put down or taken away"});
}

}  // namespace stillpoint::people
