// Networks of Caffe.
#include "fuzz/fuzz_target.hpp"
#include "segmenter_segnet/caffe_weights.hpp"
#include "segmenter_segnet/network_definition.hpp"
#include "segmenter_segnet/test_network.hpp"

namespace stillpoint::testing {
namespace {

FuzzTarget caffe_weights() {
  const auto network = segmenter_segnet::segnet_basic(32, 32, 1, 2, 1);
  return {.seeds = {bytes_of_text(network.caffemodel()),
                    bytes_of_text(network.caffemodel(segmenter_segnet::ModelFormat::kV1))},
          .parse = [](const fs::path& file) { segmenter_segnet::read_caffe_weights(file); }};
}

FuzzTarget network_definition() {
  return {.seeds = {bytes_of_text(segmenter_segnet::segnet_basic(32, 32, 1, 2, 1).prototxt())},
          .parse = [](const fs::path& file) { segmenter_segnet::read_definition(file); },
          .words = {"layer {", "}", "{", ":", "\"", "input_dim: 4294967296", "#", "include {",
                    "phase: TRAIN", "\\"}};
}

}  // namespace

std::vector<NamedFuzzTarget> network_targets() {
  return {{"CaffeWeights", caffe_weights}, {"NetworkDefinition", network_definition}};
}

}  // namespace stillpoint::testing
