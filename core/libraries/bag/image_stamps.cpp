#include "bag/image_stamps.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "bag/messages.hpp"

namespace stillpoint::bag {
namespace {

constexpr std::size_t kHeader = 512;  // bytes: a stamp and the name of a frame

constexpr double kStepBack = 1.0;  // seconds; images that come out of order are nearer

// A clock that was set back, or a recording within the recording: sorting mixes before and after.
void count_steps_back(ImageStamps& stamps) {
  for (std::size_t i = 1; i < stamps.images.size(); ++i) {
    const double step = stamps.images[i - 1].time - stamps.images[i].time;
    if (step <= kStepBack) continue;
    ++stamps.steps_back;
    stamps.largest_step_back = std::max(stamps.largest_step_back, step);
  }
}

void put_in_order(ImageStamps& stamps) {
  std::ranges::stable_sort(stamps.images, {}, &ImageStamp::time);
  const auto same = [](const ImageStamp& a, const ImageStamp& b) { return a.time == b.time; };
  const auto end = std::unique(stamps.images.begin(), stamps.images.end(), same);
  stamps.repeated = static_cast<std::size_t>(stamps.images.end() - end);
  stamps.images.erase(end, stamps.images.end());
}

std::string messages_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " message is" : " messages are");
}

std::string steps_text(std::size_t count, double largest) {
  std::ostringstream text;
  text << "the time stamps go back " << count << (count == 1 ? " time" : " times") << ", by up to "
       << std::fixed << std::setprecision(1) << largest
       << " s: images are used in order of their stamps";
  return text.str();
}

}  // namespace

std::vector<std::string> ImageStamps::warnings(const std::string& topic) const {
  std::vector<std::string> lines;
  if (unreadable > 0)
    lines.push_back(topic + ": " + messages_text(unreadable) + " left out for damage");
  if (repeated > 0)
    lines.push_back(topic + ": " + messages_text(repeated) + " left out for a repeated time stamp");
  if (steps_back > 0) lines.push_back(topic + ": " + steps_text(steps_back, largest_step_back));
  return lines;
}

std::vector<ImageStamps> image_stamps(BagReader& bag, const std::vector<ImageTopic>& topics) {
  std::vector<ImageStamps> result(topics.size());
  for (const MessagePlace& place : bag.messages()) {
    const auto topic = std::ranges::find(topics, place.topic, &ImageTopic::index);
    if (topic == topics.end()) continue;
    ImageStamps& stamps = result[static_cast<std::size_t>(topic - topics.begin())];
    try {
      const std::int64_t stamp =
          header_of(bag.read(place, kHeader), bag.topics()[place.topic].serialisation).stamp;
      stamps.images.push_back({seconds(stamp == 0 ? place.time : stamp), place});
    } catch (const Error&) {
      ++stamps.unreadable;
    }
  }
  std::ranges::for_each(result, count_steps_back);
  std::ranges::for_each(result, put_in_order);
  return result;
}

}  // namespace stillpoint::bag
