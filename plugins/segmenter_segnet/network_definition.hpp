// What a .prototxt says: the input and the layers of a network in inference.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "segmenter_segnet/text_node.hpp"

namespace stillpoint::segmenter_segnet {

struct LayerDefinition {
  std::string name;
  std::string type;
  std::vector<std::string> bottoms;  ///< blobs it reads
  std::vector<std::string> tops;     ///< blobs it writes; may be those it reads ("in place")
  TextNode node;                     ///< all that the file says about it

  /// The fields of `<name>_param`; without any where the file has none.
  const TextNode& parameters(std::string_view field) const;
  /// For messages: file:line and the layer.
  std::string where() const { return node.where + ": layer '" + name + "'"; }
};

struct NetworkDefinition {
  std::string input;       ///< blob
  std::vector<int> shape;  ///< of the input: 1, channels, height, width
  std::vector<LayerDefinition> layers;
};

/// Leaves out layers that are there for training only. Throws Error(kData) when the file is no
/// definition of a network for inference.
NetworkDefinition read_definition(const std::filesystem::path& file);

}  // namespace stillpoint::segmenter_segnet
