// What a list of recordings says: which people do what in which part of which recording.
#pragma once

#include <string>
#include <vector>

#include "stillpoint/options.hpp"

namespace stillpoint::people {

/// Somebody who is cut out of a photograph. Places are metres in the level frame of the recording's
/// first camera: x to its right, y ahead of it, along the floor; times are seconds from the first
/// frame.
struct PersonPlan {
  enum class Clothes { kAny, kDark, kBright } clothes = Clothes::kAny;
  std::vector<double> walk;  ///< time, x, y, time, x, y, …
  bool again = true;         ///< the walk begins anew when it is over
  std::vector<double> sits;  ///< from, to, from, to, …
  double height = 1.75;      ///< m, of what the photograph shows
  double elevation = 0;  ///< m of its lower end above the floor: of who is seen from the waist up
  std::string photo;     ///< this one instead of a drawn one; its mask is NAME_gt.png
  std::vector<double> part;  ///< x, y, width, height in px of the photo; empty: all of it

  void visit(OptionVisitor& v);
};

/// A box with photographs on its sides. `path`: time, x, y, z of the middle of its foot, z above
/// the floor; it stays where it is before the first and after the last time.
struct ThingPlan {
  std::vector<double> size = {0.3, 0.3, 0.3};  ///< m: across, along, up
  std::vector<double> path;
  double turn = 20;  ///< degrees about the vertical

  void visit(OptionVisitor& v);
};

/// A recording without people.
struct BasePlan {
  std::string folder;  ///< of the TUM RGB-D benchmark, with associations.txt and groundtruth.txt
  std::string camera;  ///< file; empty: camera.yaml in the folder
  double floor = 0;    ///< m, its height in the world of groundtruth.txt, whose z points upwards
  double blur = 0.7;   ///< px, standard deviation: how sharp the recording is
  double exposure = 0.01;    ///< s
  std::vector<double> desk;  ///< m, lowest and highest of what is labelled a table where the base
                             ///< has no labels, in the world of groundtruth.txt; empty: nothing

  void visit(OptionVisitor& v);
};

struct RecordingPlan {
  std::string name;
  std::string base;
  int seed = 1;      ///< of who comes, and of the depth sensor's noise
  int first = 0;     ///< pair of the base
  int count = 0;     ///< pairs; 0: to the end
  double lower = 0;  ///< m by which people and things stand below the floor of the base
  std::vector<PersonPlan> people;
  std::vector<ThingPlan> things;

  void visit(OptionVisitor& v);
};

}  // namespace stillpoint::people
