// Real people in a real recording:
//   paste_people RECORDING PHOTOS SEED OUT [FIRST COUNT]
// RECORDING: TUM's fr1_xyz, with associations.txt; PHOTOS: the folder of the annotated TUM fr3
// frames. OUT is a recording (of COUNT pairs from the FIRST on) for `stillpoint run --camera
// tum_fr1` and tools/measure.
#include "support/pasted_people.hpp"

#include <iostream>
#include <limits>

int main(int count, char** arguments) {
  if (count != 5 && count != 7) {
    std::cerr << "usage: paste_people RECORDING PHOTOS SEED OUT [FIRST COUNT]\n";
    return 2;
  }
  try {
    const bool part = count == 7;
    stillpoint::testing::paste_people(
        arguments[1], arguments[2], std::stoi(arguments[3]), part ? std::stoul(arguments[5]) : 0,
        part ? std::stoul(arguments[6]) : std::numeric_limits<std::size_t>::max(), arguments[4]);
  } catch (const std::exception& error) {
    std::cerr << "paste_people: " << error.what() << "\n";
    return 1;
  }
}
