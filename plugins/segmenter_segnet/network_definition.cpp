#include "segmenter_segnet/network_definition.hpp"

#include <algorithm>
#include <utility>

#include "stillpoint/error.hpp"

namespace stillpoint::segmenter_segnet {
namespace {

constexpr int kLargestSide = 8192;  // px

constexpr const char* kInferenceRemedy =
    "use the definition for inference, such as segnet_pascal.prototxt of the SegNet tutorial";

/// NetStateRule: a layer may be for one phase only.
bool used_in_inference(const TextNode& layer) {
  const auto names_phase = [](const char* phase) {
    return [phase](const TextNode* rule) { return rule->text("phase") == phase; };
  };
  return std::ranges::none_of(layer.all("include"), names_phase("TRAIN")) &&
         std::ranges::none_of(layer.all("exclude"), names_phase("TEST"));
}

std::vector<std::string> values_of(const TextNode& layer, std::string_view field) {
  std::vector<std::string> values;
  for (const TextNode* node : layer.all(field)) values.push_back(node->value);
  return values;
}

LayerDefinition layer_of(const TextNode& node) {
  LayerDefinition layer{.name = node.text("name"),
                        .type = node.text("type"),
                        .bottoms = values_of(node, "bottom"),
                        .tops = values_of(node, "top"),
                        .node = node};
  if (layer.name.empty() || layer.type.empty() || layer.tops.empty())
    throw Error(Fault::kData, "a layer needs a name, a type and a top", node.where);
  return layer;
}

std::vector<int> dimensions_of(const TextNode& node, std::string_view field) {
  std::vector<int> dimensions;
  for (const TextNode* size : node.all(field)) dimensions.push_back(size->as_integer());
  return dimensions;
}

void set_input(NetworkDefinition& network, std::string blob, std::vector<int> shape,
               const std::string& where) {
  if (shape.size() != 4 || shape[1] != 3 ||
      std::ranges::any_of(shape, [](int size) { return size < 1 || size > kLargestSide; }))
    throw Error(Fault::kData, "the input must be 1 x 3 x height x width", where);
  shape[0] = 1;  // Bayesian SegNet has a batch of Monte Carlo samples; without dropout one suffices
  network.input = std::move(blob);
  network.shape = std::move(shape);
}

/// The input by `input:` and its shape, in both ways there are.
void read_input_fields(NetworkDefinition& network, const TextNode& root) {
  const TextNode* input = root.find("input");
  if (!input) return;
  const TextNode* shape = root.find("input_shape");
  set_input(network, input->value,
            shape ? dimensions_of(*shape, "dim") : dimensions_of(root, "input_dim"), input->where);
}

void read_input_layer(NetworkDefinition& network, const LayerDefinition& layer) {
  const TextNode* shape = layer.parameters("input_param").find("shape");
  set_input(network, layer.tops.front(), shape ? dimensions_of(*shape, "dim") : std::vector<int>{},
            layer.where());
}

}  // namespace

const TextNode& LayerDefinition::parameters(std::string_view field) const {
  static const TextNode kNone{.is_message = true};
  const TextNode* found = node.find(field);
  return found && found->is_message ? *found : kNone;
}

NetworkDefinition read_definition(const std::filesystem::path& file) {
  const TextNode root = read_text_file(file);
  if (root.find("layers"))
    throw Error(Fault::kData, "has layers of the old format (V1), which knows no Upsample",
                file.string(), kInferenceRemedy);
  NetworkDefinition network;
  read_input_fields(network, root);
  for (const TextNode* node : root.all("layer")) {
    if (!used_in_inference(*node)) continue;
    LayerDefinition layer = layer_of(*node);
    if (layer.type == "Input")
      read_input_layer(network, layer);
    else
      network.layers.push_back(std::move(layer));
  }
  if (network.layers.empty())
    throw Error(Fault::kData, "defines no layers", file.string(), kInferenceRemedy);
  if (network.input.empty())
    throw Error(Fault::kData, "has no input", file.string(), kInferenceRemedy);
  return network;
}

}  // namespace stillpoint::segmenter_segnet
