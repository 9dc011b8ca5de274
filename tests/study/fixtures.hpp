// A study, and results of it, without any run.
#pragma once

#include <string>

#include "study/study_results.hpp"

namespace stillpoint::study {

inline Study two_by_two(int repeats) {
  Study study;
  study.repeats = repeats;
  study.seed = 7;
  for (const char* name : {"walking", "walking_empty"}) {
    Sequence sequence;
    sequence.name = name;
    sequence.dataset = std::string("/recordings/") + name;
    study.sequences.push_back(sequence);
  }
  for (const char* name : {"plain", "better"}) {
    Variant variant;
    variant.name = name;
    variant.pipeline = "orb_baseline";
    study.variants.push_back(variant);
  }
  study.variants[1].set = {"tracker.features=2000"};
  return study;
}

inline CellResult result_with(double ate, double coverage = 100.0) {
  CellResult result;
  result.origin = {"1.2.3", "0123456789ab", "a machine, 2 cores", "2026-01-30"};
  result.seconds = 2.5;
  result.values[kAte] = ate;
  result.values[kCoverage] = coverage;
  result.values[kTimesLost] = 0.0;
  return result;
}

}  // namespace stillpoint::study
