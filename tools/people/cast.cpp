#include "people/cast.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "people/relighting.hpp"
#include "people/smear.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "stillpoint/support/image_file.hpp"

namespace stillpoint::people {
namespace {

namespace fs = std::filesystem;

cv::Rect part_of(const PersonPlan& plan, cv::Size photo) {
  if (plan.part.empty()) return {{}, photo};
  const std::vector<double>& p = plan.part;
  return cv::Rect(cvRound(p[0]), cvRound(p[1]), cvRound(p[2]), cvRound(p[3])) & cv::Rect({}, photo);
}

CutOut named_person(const PersonPlan& plan, int seed) {
  const fs::path image = plan.photo;
  const fs::path mask = image.parent_path() / (image.stem().string() + "_gt.png");
  const MaskedPhoto photo = read_photo(image, mask);
  const cv::Rect part = part_of(plan, photo.bgr.size());
  return cut_out(photo.bgr(part), photo.mask(part), seed);
}

CutOut drawn_person(const PersonPhoto& drawn, int seed) {
  const MaskedPhoto photo = read_photo(drawn.image, drawn.mask);
  return cut_out(photo.bgr, photo.mask, seed);
}

std::array<cv::Mat, 3> sides_from(const std::vector<fs::path>& pictures, cv::RNG& random) {
  std::array<cv::Mat, 3> sides;
  for (cv::Mat& side : sides) {
    if (pictures.empty())
      throw Error(Fault::kData, "there are no pictures for the sides of a thing", "",
                  "name a folder of them");
    const fs::path& file =
        pictures[static_cast<std::size_t>(random.uniform(0, static_cast<int>(pictures.size())))];
    side = decode_image(read_image_file(file), cv::IMREAD_COLOR);
    if (side.empty()) throw Error(Fault::kData, "the image cannot be read", file.string());
  }
  return sides;
}

}  // namespace

std::vector<BasePair> pairs_of(const RecordingPlan& plan, const BaseRecording& base) {
  const std::size_t all = base.pairs().size();
  const auto first = static_cast<std::size_t>(plan.first);
  if (first >= all)
    throw Error(Fault::kUsage, "begins after the end of its base", "recording '" + plan.name + "'",
                "the base has " + std::to_string(all) + " pairs");
  const std::size_t count =
      plan.count == 0 ? all - first : std::min(all - first, static_cast<std::size_t>(plan.count));
  const auto begin = base.pairs().begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

Cast::Cast(const RecordingPlan& plan, const BaseRecording& base, const Sources& sources)
    : base_(base), start_(pairs_of(plan, base).front().time) {
  level_from_world_ = world_from_level(base.world_from_camera(start_), base.plan().floor).inverse();
  const std::vector<PersonPhoto> drawn = draw_people(sources.people, plan.people, plan.seed);
  auto next = drawn.begin();
  int seed = 1000 * plan.seed;
  for (const PersonPlan& person : plan.people) {
    ++seed;
    CutOut cut = person.photo.empty() ? drawn_person(*next++, seed) : named_person(person, seed);
    figures_.emplace_back(person, std::move(cut), plan.lower, seed);
  }
  cv::RNG random(static_cast<std::uint64_t>(plan.seed) + 77);
  for (const ThingPlan& thing : plan.things)
    things_.emplace_back(thing, sides_from(sources.pictures, random), plan.lower);
  light_figures(plan);
}

/// By some frames from all of the recording; their light stays the same then, as that of a room
/// does.
void Cast::light_figures(const RecordingPlan& plan) {
  constexpr std::size_t kLooks = 12;
  std::vector<Surroundings> around(figures_.size());
  const std::vector<BasePair> pairs = pairs_of(plan, base_);
  for (std::size_t i = 0; i < kLooks; ++i) {
    const BasePair& pair = pairs[i * pairs.size() / kLooks];
    const std::vector<Layer> layers = shapes_at(pair.time);
    const cv::Mat bgr = base_.color(pair);
    for (std::size_t k = 0; k < figures_.size(); ++k) around[k].add(layers[k], bgr);
  }
  for (std::size_t k = 0; k < figures_.size(); ++k)
    figures_[k].relight(gain_for(around[k], figures_[k].cut()));
}

Pose Cast::level_from_camera(double time) const {
  return level_from_world_ * base_.world_from_camera(time);
}

std::vector<Layer> Cast::shapes_at(double time) const {
  std::vector<Layer> layers;
  const Pose pose = level_from_camera(time);
  for (const Figure& figure : figures_)
    layers.push_back(figure.shape_from(pose, base_.rays(), time - start_));
  for (const Thing& thing : things_)
    layers.push_back(thing.seen_from(pose, base_.rays(), time - start_));
  return layers;
}

std::vector<Layer> Cast::seen_at(double time) const {
  std::vector<Layer> layers;
  const Pose pose = level_from_camera(time);
  for (const Figure& figure : figures_)
    layers.push_back(figure.seen_from(pose, base_.rays(), time - start_));
  for (const Thing& thing : things_)
    layers.push_back(thing.seen_from(pose, base_.rays(), time - start_));
  const double exposure = base_.plan().exposure;
  const Pose camera_at_end_from_begin =
      level_from_camera(time + exposure / 2).inverse() * level_from_camera(time - exposure / 2);
  for (Layer& layer : layers)
    smear(layer, camera_at_end_from_begin, base_.rays(), base_.plan().blur);
  return layers;
}

}  // namespace stillpoint::people
