// Recordings with real people, with a known truth:
//   paste_people LIST OUT [THREADS [NAME…]]
// LIST: as tests/benchmarks/real_people.yaml. Every recording becomes a folder of its name in OUT
// for `stillpoint run --dataset`; those already there are left alone, without NAMEs all are made.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <opencv2/core/utility.hpp>
#include <set>

#include "people/maker.hpp"
#include "stillpoint/engine/freed_memory.hpp"
#include "support/people_list.hpp"

namespace {

namespace fs = std::filesystem;
using namespace stillpoint;

people::Sources sources_of(const testing::PeopleList& list) {
  people::Sources sources;
  sources.people = people::held_out_people({list.people_from.begin(), list.people_from.end()});
  for (const std::string& folder : list.pictures_from)
    for (const fs::path& image : people::held_out_images(folder)) sources.pictures.push_back(image);
  return sources;
}

void make(const people::RecordingPlan& plan, const testing::PeopleList& list,
          const people::Sources& sources, const fs::path& out, int threads) {
  const auto begin = std::chrono::steady_clock::now();
  const people::BasePlan& base_plan = list.bases.at(plan.base);
  const CameraModel camera = testing::camera_of(base_plan);
  const people::BaseRecording base(base_plan, camera);
  const auto [frames, mean, max] = people::make_recording(plan, base, sources, out, threads);
  std::ofstream(out / "camera.yaml") << "version: 1\n" << camera_yaml(camera);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::cout << std::left << std::setw(28) << plan.name << std::right << std::fixed
            << std::setprecision(1) << std::setw(5) << frames << " frames, people cover "
            << std::setw(5) << 100 * mean << " % on average, " << std::setw(5) << 100 * max
            << " % at most; " << seconds.count() << " s" << std::endl;
}

int run(const std::vector<std::string>& arguments) {
  const testing::PeopleList list = testing::load_people_list(arguments.at(0));
  const fs::path out = arguments.at(1);
  const int threads = arguments.size() > 2 ? std::stoi(arguments[2]) : 2;
  const std::set<std::string> names(
      arguments.begin() + std::min<std::ptrdiff_t>(3, std::ssize(arguments)), arguments.end());
  const people::Sources sources = sources_of(list);
  std::cout << sources.people.size() << " people, " << sources.pictures.size() << " pictures\n";
  fs::create_directories(out);
  for (const people::RecordingPlan& plan : list.recordings)
    if ((names.empty() || names.contains(plan.name)) && !fs::exists(out / plan.name))
      make(plan, list, sources, out / plan.name, threads);
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  keep_freed_memory();
  cv::setNumThreads(1);  // frames are made side by side
  if (count < 3) {
    std::cerr << "usage: paste_people LIST OUT [THREADS [NAME…]]\n";
    return 2;
  }
  try {
    return run({arguments + 1, arguments + count});
  } catch (const std::exception& error) {
    std::cerr << "paste_people: " << error.what() << "\n";
    return 1;
  }
}
