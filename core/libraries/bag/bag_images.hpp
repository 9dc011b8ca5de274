// The images of the topics that were chosen.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "bag/image_stamps.hpp"
#include "bag/raw_image.hpp"
#include "bag/topic_choice.hpp"

namespace stillpoint::bag {

/// Throws Error(kData), which names topic and time, when an image is damaged or of a kind that is
/// not read. `FileDecoder` decodes files such as PNG, as tum_recording::ImageDecoder does, of which
/// this library knows nothing. One per thread.
template <class FileDecoder>
class BagImages {
 public:
  /// The bag is used as long as this is.
  BagImages(BagReader& bag, const TopicChoice& choice)
      : bag_(bag), color_(choice.color), depth_(choice.depth) {}

  /// CV_8UC3 in BGR order.
  cv::Mat color(const ImageStamp& stamp) {
    return pixels_of(color_, stamp, [this](const ImageMessage& image) {
      return image.description.compressed ? decoder_.color(image.data, "") : color_pixels(image);
    });
  }

  /// CV_16UC1 as recorded, or CV_32FC1 in metres.
  cv::Mat depth(const ImageStamp& stamp) {
    return pixels_of(depth_, stamp, [this](const ImageMessage& image) {
      if (!image.description.compressed) return depth_pixels(image);
      const CompressedDepth compressed = compressed_depth(image);
      const cv::Mat stored = decoder_.depth(compressed.png, "");
      return compressed.inverse_header.empty()
                 ? stored
                 : metres_of_inverse_depth(stored, compressed.inverse_header);
    });
  }

 private:
  template <class Decode>
  cv::Mat pixels_of(const ImageTopic& topic, const ImageStamp& stamp, Decode decode) {
    try {
      return decode(read_image(bag_.read(stamp.place), bag_.topics()[topic.index].serialisation,
                               topic.first.compressed));
    } catch (const Error& error) {
      throw Error(error.fault(), error.what(),
                  topic.name + " at " + std::to_string(stamp.time) + " s");
    }
  }

  BagReader& bag_;
  ImageTopic color_, depth_;
  FileDecoder decoder_;
};

}  // namespace stillpoint::bag
