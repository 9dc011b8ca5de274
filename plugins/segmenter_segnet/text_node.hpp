// Protocol buffers in their text form (a .prototxt), without a schema. OpenCV's own reader knows
// only the fields of its caffe.proto and refuses a file with `bn_param` or `upsample_param`.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace stillpoint::segmenter_segnet {

/// One field: a scalar with its `value`, or a message with its fields.
struct TextNode {
  std::string name;
  std::string value;  ///< as written, strings without their quotes; empty for a message
  bool is_message = false;
  std::vector<TextNode> fields;
  std::string where;  ///< file:line

  /// The field of this name; the last one, as protocol buffers define; nullptr without one.
  const TextNode* find(std::string_view field) const;
  std::vector<const TextNode*> all(std::string_view field) const;

  std::string text(std::string_view field, const std::string& fallback = {}) const;
  /// Throws Error(kData) with the line when the value is no integer, or not true or false.
  int integer(std::string_view field, int fallback) const;
  bool boolean(std::string_view field, bool fallback) const;

  /// Of this node itself.
  int as_integer() const;
};

/// The file as one message. Throws Error(kData) with the line of the first mistake.
TextNode read_text_file(const std::filesystem::path& file);

TextNode parse_text(std::string_view text, const std::string& file);

}  // namespace stillpoint::segmenter_segnet
