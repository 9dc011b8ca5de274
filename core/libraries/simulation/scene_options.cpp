#include "simulation/scene_options.hpp"

namespace stillpoint::simulation {
namespace {

constexpr double kFarthest = 1000;  // m, from the origin: far beyond every room

/// A point, or several.
OptionInfo point(std::string_view help) {
  return {.min = -kFarthest, .max = kFarthest, .unit = "m", .help = help};
}

}  // namespace

void RoomOptions::visit(OptionVisitor& v) {
  v.choice(
      "plan", plan,
      {{"office", Plan::kOffice}, {"suite", Plan::kSuite}, {"corridor", Plan::kCorridor}},
      {.help = "office: one room; suite: ten rooms of 6 x 6 m in two rows, in a ring of doorways; "
               "corridor: 2 m wide, 16 m long, things at its beginning only"});
  v.choice("walls", walls, {{"rich", Walls::kRich}, {"poor", Walls::kPoor}},
           {.help = "rich: posters, boards and shelves on the walls; poor: bare plaster"});
  v("furnished", furnished, {.help = "desks, chairs, monitors, shelves and what lies on them"});
  v("texture", texture,
    {.min = 0,
     .max = 1,
     .help = "relative contrast of plaster, carpet and ceiling; 1: as usual, 0: uniform colours"});
  v("alike", alike, {.help = "every room of a suite is furnished alike (perceptual aliasing)"});
  v("seed", seed, {.min = 0, .help = "seed of what is printed on posters, papers and books"});
  v("photographs", photographs,
    {.help = "folder of images that cover walls, floor, boards, desks and boxes; empty: painted",
     .is_path = true});
}

void MotionOptions::visit(OptionVisitor& v) {
  v.choice("kind", kind,
           {{"static", Kind::kStatic},
            {"xyz", Kind::kXyz},
            {"rpy", Kind::kRpy},
            {"halfsphere", Kind::kHalfsphere},
            {"loop", Kind::kLoop},
            {"walk", Kind::kWalk}},
           {.help = "as in the sequences of the TUM benchmark; loop: once around the room; walk: "
                    "along the path, looking ahead"});
  v("position", position, point("x, y, z of the centre of the motion; of a walk z only"));
  v("look_at", look_at, point("x, y, z of the point in the middle of the view"));
  v("path", path, point("x, y, x, y, … on the floor, of a walk round and round"));
  v("extent", extent, {.min = 0, .max = 3, .help = "scales the size of the motion"});
  v("speed", speed, {.min = 0.01, .max = 10, .help = "scales the rate of the motion"});
  v("jitter", jitter, {.min = 0, .max = 10, .help = "scales the shake of a hand-held camera"});
  v.require(position.size() == 3 && look_at.size() == 3, "position and look_at take x, y, z");
  v.require(path.size() % 2 == 0 && (kind != Kind::kWalk || path.size() >= 6),
            "path takes pairs x, y; a walk three or more of them");
  v.require(position.size() != 3 || look_at.size() != 3 || position[0] != look_at[0] ||
                position[1] != look_at[1],
            "look_at must not lie right above or below position");
}

void SensorOptions::visit(OptionVisitor& v) {
  v("ideal", ideal, {.help = "no noise, blur, holes, drift or quantisation"});
  v("exposure", exposure,
    {.min = 0, .max = 0.1, .unit = "s", .help = "exposure time of a colour image"});
  v("exposure_drift", exposure_drift,
    {.min = 0, .max = 0.5, .help = "relative amplitude of slow changes of brightness"});
  v("color_noise", color_noise,
    {.min = 0,
     .max = 50,
     .unit = "grey levels",
     .help = "standard deviation of a colour channel at middle grey"});
  v("disparity_noise", disparity_noise,
    {.min = 0,
     .max = 2,
     .unit = "px",
     .help = "standard deviation of the disparity; larger: noisier depth"});
  v("disparity_step", disparity_step,
    {.min = 0, .max = 2, .unit = "px", .help = "quantisation of the disparity; 0: none"});
  v("baseline_focal", baseline_focal,
    {.min = 1,
     .max = 1e6,
     .unit = "px m",
     .help = "depth = this / disparity; Kinect: 0.075 m x 580 px"});
  v("min_range", min_range,
    {.min = 0, .max = kFarthest, .unit = "m", .help = "nearer surfaces are not measured"});
  v("max_range", max_range,
    {.min = 0.1, .max = kFarthest, .unit = "m", .help = "farther ones are not measured"});
  v("depth_offset", depth_offset,
    {.min = -0.1,
     .max = 0.1,
     .unit = "s",
     .help = "how much later than the colour image its depth image is taken"});
  v("depth_offset_drift", depth_offset_drift,
    {.min = -0.01,
     .max = 0.01,
     .unit = "s/s",
     .help = "growth of depth_offset per second, as of two clocks; wraps around at half a frame"});
  v.require(min_range < max_range, "min_range must be smaller than max_range");
}

void PersonOptions::visit(OptionVisitor& v) {
  v.choice("pose", pose, {{"walk", Pose::kWalk}, {"sit", Pose::kSit}},
           {.help = "walking along the path, or sitting at its first point and gesturing"});
  v("path", path, point("x, y, x, y, … on the floor; walked round and round"));
  v("speed", speed, {.min = 0.05, .max = 3, .unit = "m/s", .help = "mean speed of walking"});
  v("start", start,
    {.min = 0, .max = 1e6, .unit = "m", .help = "distance along the path at the first frame"});
  v("heading", heading,
    {.min = -360,
     .max = 360,
     .unit = "degrees",
     .help = "where a sitting person faces: 0 is +x, 90 is +y"});
  v("height", height,
    {.min = 0.8, .max = 2.3, .unit = "m", .help = "height of the standing person"});
  v("shirt", shirt, {.help = "pattern of the shirt: plaid, striped or plain"});
  v("carries_box", carries_box, {.help = "carries a cardboard box in both arms"});
  v("seed", seed, {.min = 0, .help = "seed of rhythm and clothes"});
  v.require(path.size() % 2 == 0 && path.size() >= (pose == Pose::kWalk ? 6 : 2),
            "path takes pairs x, y: three or more of them to walk, one to sit");
  v.require(shirt == "plaid" || shirt == "striped" || shirt == "plain",
            "shirt is plaid, striped or plain");
}

void BallOptions::visit(OptionVisitor& v) {
  v("from", from, point("x, y, z of one hand"));
  v("to", to, point("x, y, z of the other hand"));
  v("flight", flight, {.min = 0.1, .max = 5, .unit = "s", .help = "time that a throw takes"});
  v("pause", pause, {.min = 0, .max = 60, .unit = "s", .help = "time between throws"});
  v("radius", radius, {.min = 0.01, .max = 0.5, .unit = "m", .help = "radius of the ball"});
  v.require(from.size() == 3 && to.size() == 3, "from and to take x, y, z");
}

void SceneOptions::visit(OptionVisitor& v) {
  v("frames", frames,
    {.min = 1, .max = 100000, .unit = "frames", .help = "length of the recording"});
  v("rate", rate, {.min = 1, .max = 240, .unit = "Hz", .help = "frames per second"});
  v("start_time", start_time,
    {.min = 0, .max = 1e10, .unit = "s", .help = "time stamp of the first frame"});
  v("seed", seed, {.min = 0, .help = "seed of the sensor's noise and of the camera's shake"});
  v("room", room, {.help = "the room and what stands in it"});
  v("motion", motion, {.help = "motion of the camera"});
  v("sensor", sensor, {.help = "noise, exposure, range and timing of the camera"});
  v("people", people, {.help = "people who walk or sit in the room"});
  v("balls", balls, {.help = "balls that are thrown to and fro"});
}

}  // namespace stillpoint::simulation
