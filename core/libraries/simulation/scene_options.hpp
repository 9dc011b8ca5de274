// Everything a scene file can say about a simulated recording.
#pragma once

#include <string>
#include <vector>

#include "stillpoint/options.hpp"

namespace stillpoint::simulation {

/// World frame: metres, z up, floor at 0; the office's desks ahead of the camera along +y.
struct RoomOptions {
  enum class Plan { kOffice, kSuite, kCorridor } plan = Plan::kOffice;
  enum class Walls { kRich, kPoor } walls = Walls::kRich;
  bool furnished = true;
  double texture = 1.0;  ///< contrast of what walls, floor and ceiling are covered with
  bool alike = false;    ///< the rooms of a suite
  int seed = 1;          ///< of what is printed on posters, papers and books
  std::string
      photographs;  ///< folder: they cover walls, floor, boards, desks and boxes; empty: none

  void visit(OptionVisitor& v);
};

struct MotionOptions {
  enum class Kind { kStatic, kXyz, kRpy, kHalfsphere, kLoop, kWalk } kind = Kind::kXyz;
  std::vector<double> position = {-0.1, -1.75, 1.4};  ///< metres, centre of the motion
  std::vector<double> look_at = {0.05, 1.2, 0.85};    ///< metres
  std::vector<double> path;                           ///< x, y, x, y, … of a closed walk, metres
  double extent = 1.0;                                ///< scales the size of the motion
  double speed = 1.0;                                 ///< scales its rate
  double jitter = 1.0;                                ///< scales the trembling of the hand

  void visit(OptionVisitor& v);
};

struct SensorOptions {
  bool ideal = false;            ///< geometry and colours as they are: no noise, no blur, no holes
  double exposure = 0.008;       ///< s
  double exposure_drift = 0.05;  ///< relative amplitude
  double color_noise = 0.9;      ///< grey levels, standard deviation at middle grey
  double disparity_noise = 0.055;   ///< px, standard deviation
  double disparity_step = 0.125;    ///< px
  double baseline_focal = 43.5;     ///< px·m: baseline times focal length of the infrared camera
  double min_range = 0.5;           ///< m
  double max_range = 6.0;           ///< m
  double depth_offset = 0.0;        ///< s, depth image after colour image
  double depth_offset_drift = 0.0;  ///< s per s; rolls over at half a frame

  void visit(OptionVisitor& v);
};

struct PersonOptions {
  enum class Pose { kWalk, kSit } pose = Pose::kWalk;
  std::vector<double> path = {-2, 0, 2, 0, 2, 0.6, -2, 0.6};  ///< x, y, x, y, … of a closed walk
  double speed = 0.9;                                         ///< m/s, mean
  double start = 0.0;    ///< metres along the path at the first frame
  double heading = 0.0;  ///< degrees from +x towards +y, of who sits
  double height = 1.76;  ///< m
  std::string shirt = "plaid";
  bool carries_box = false;
  int seed = 1;  ///< of rhythm and clothes

  void visit(OptionVisitor& v);
};

struct BallOptions {
  std::vector<double> from = {-1.2, 0.3, 1.3};  ///< m
  std::vector<double> to = {1.2, 0.3, 1.3};     ///< m
  double flight = 0.9;                          ///< s, one way
  double pause = 0.6;                           ///< s, in the hand
  double radius = 0.11;                         ///< m

  void visit(OptionVisitor& v);
};

/// The `source:` section of a scene file.
struct SceneOptions {
  int frames = 860;
  double rate = 30.0;        ///< Hz
  double start_time = 1000;  ///< s
  int seed = 1;              ///< of the noise and of the hand's trembling
  RoomOptions room;
  MotionOptions motion;
  SensorOptions sensor;
  std::vector<PersonOptions> people;
  std::vector<BallOptions> balls;

  void visit(OptionVisitor& v);
};

}  // namespace stillpoint::simulation
