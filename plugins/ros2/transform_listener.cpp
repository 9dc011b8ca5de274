#include "ros2/transform_listener.hpp"

#include "bag/messages.hpp"
#include "ros2_messages/messages.hpp"

namespace stillpoint::ros2 {
namespace {

using std::chrono::steady_clock;

constexpr int kMovingKept = 100, kStaticKept = 100;  // messages, as tf2's listener has it

void add(FrameBuffer& frames, const Bytes& message, FrameBuffer::Topic topic) try {
  for (const bag::TransformMessage& transform :
       bag::read_transforms(message, bag::Serialisation::kCdr))
    frames.add(transform, topic);
} catch (const Error&) {  // a message that is cut short says nothing
}

}  // namespace

TransformListener::TransformListener(const Participant& participant)
    : tf_(participant, "/tf", ros2_messages::Transform::kType, kMovingKept, true),
      tf_static_(participant, "/tf_static", ros2_messages::Transform::kType, kStaticKept, true,
                 Kept::kLast) {}

bool TransformListener::read(steady_clock::time_point deadline) {
  bool has_read = false;
  const auto now = steady_clock::now();
  const auto take = [&](const Reader& reader, FrameBuffer::Topic topic,
                        steady_clock::time_point until) {
    while (const auto message = reader.take(until)) {
      add(frames_, *message, topic);
      has_read = true;
      until = now;
    }
  };
  take(tf_static_, FrameBuffer::Topic::kTfStatic, now);
  take(tf_, FrameBuffer::Topic::kTf, has_read ? now : deadline);
  return has_read;
}

std::optional<Pose> TransformListener::target_from_source(const std::string& target,
                                                          const std::string& source,
                                                          std::optional<double> time,
                                                          std::chrono::milliseconds patience) {
  const auto deadline = steady_clock::now() + patience;
  read(steady_clock::now());
  for (;;) {
    if (const auto pose = frames_.target_from_source(target, source, time)) return pose;
    if (!read(deadline)) return std::nullopt;
  }
}

}  // namespace stillpoint::ros2
