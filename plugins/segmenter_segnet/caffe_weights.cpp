#include "segmenter_segnet/caffe_weights.hpp"

#include <bit>
#include <cstring>
#include <numeric>
#include <span>

#include "segmenter_segnet/wire_reader.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/input_file.hpp"

namespace stillpoint::segmenter_segnet {
namespace {

static_assert(std::endian::native == std::endian::little, "as protocol buffers are");

using Type = WireField::Type;

/// Numbers of the fields in caffe.proto.
struct LayerFields {
  std::uint32_t layer;  // in NetParameter
  std::uint32_t name;   // in the layer
  std::uint32_t blobs;
};
constexpr LayerFields kLayer{.layer = 100, .name = 1, .blobs = 7};
constexpr LayerFields kV1Layer{.layer = 2, .name = 4, .blobs = 6};
constexpr std::uint32_t kLegacyDimensions = 4;  // fields 1 … 4: num, channels, height, width
constexpr std::uint32_t kBlobData = 5;
constexpr std::uint32_t kBlobShape = 7;
constexpr std::uint32_t kBlobDoubleData = 8;
constexpr std::size_t kMaxDimensions = 32;  // of a cv::Mat

/// Packed or one by one.
template <class Number>
void append_numbers(const WireField& field, std::vector<float>& values) {
  for (auto rest = field.data; rest.size() >= sizeof(Number); rest = rest.subspan(sizeof(Number))) {
    Number number;
    std::memcpy(&number, rest.data(), sizeof number);
    values.push_back(static_cast<float>(number));
  }
}
template <>
void append_numbers<float>(const WireField& field, std::vector<float>& values) {
  const std::size_t old_size = values.size(), more = field.data.size() / sizeof(float);
  if (more == 0) return;
  values.resize(old_size + more);
  std::memcpy(values.data() + old_size, field.data.data(), more * sizeof(float));
}

int dimension(std::uint64_t value) {
  if (value > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
    throw Error(Fault::kData, "a blob has an impossible dimension");
  return static_cast<int>(value);
}

std::vector<int> parse_shape(std::span<const std::byte> message) {
  std::vector<int> shape;
  for (WireReader reader(message); const auto field = reader.next();) {
    if (field->number != 1) continue;
    if (field->type == Type::kVarint) shape.push_back(dimension(field->varint));
    for (WireReader packed(field->data); !packed.done();)
      shape.push_back(dimension(packed.varint()));
  }
  return shape;
}

/// The values as a blob of this shape; throws when there are more or fewer.
cv::Mat shaped(std::vector<int> shape, std::vector<float>& values) {
  const double expected = std::accumulate(shape.begin(), shape.end(), 1.0, std::multiplies<>());
  if (expected != static_cast<double>(values.size()) || values.empty())
    throw Error(Fault::kData, "a blob has " + std::to_string(values.size()) +
                                  " values, but its shape is " + shape_text(shape));
  if (shape.size() > kMaxDimensions)
    throw Error(Fault::kData, "a blob has " + std::to_string(shape.size()) + " dimensions");
  if (shape.size() < 2) shape.insert(shape.begin(), 2 - shape.size(), 1);
  return cv::Mat(static_cast<int>(shape.size()), shape.data(), CV_32F, values.data()).clone();
}

cv::Mat parse_blob(std::span<const std::byte> message) {
  std::vector<int> shape, legacy(kLegacyDimensions, 1);
  bool has_shape = false;
  std::vector<float> values;
  for (WireReader reader(message); const auto field = reader.next();) {
    if (field->number >= 1 && field->number <= kLegacyDimensions && field->type == Type::kVarint)
      legacy[field->number - 1] = dimension(field->varint);
    if (field->number == kBlobShape) {
      shape = parse_shape(field->data);
      has_shape = true;
    }
    if (field->number == kBlobData) append_numbers<float>(*field, values);
    if (field->number == kBlobDoubleData) append_numbers<double>(*field, values);
  }
  return shaped(has_shape ? shape : legacy, values);
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void parse_layer(std::span<const std::byte> message, const LayerFields& numbers,
                 CaffeWeights& weights) {
  std::string name;
  std::vector<std::span<const std::byte>> blobs;
  for (WireReader reader(message); const auto field = reader.next();) {
    if (field->type != Type::kBytes) continue;
    if (field->number == numbers.name) name = text_of(field->data);
    if (field->number == numbers.blobs) blobs.push_back(field->data);
  }
  if (blobs.empty()) return;
  std::vector<cv::Mat>& layer = weights[name];
  layer.clear();
  try {
    for (const auto& blob : blobs) layer.push_back(parse_blob(blob));
  } catch (const Error& error) {
    throw Error(Fault::kData, "layer '" + name + "': " + error.what());
  }
}

CaffeWeights parse_network(std::span<const std::byte> message) {
  CaffeWeights weights;
  for (WireReader reader(message); const auto field = reader.next();) {
    if (field->type != Type::kBytes) continue;
    for (const LayerFields& numbers : {kLayer, kV1Layer})
      if (field->number == numbers.layer) parse_layer(field->data, numbers, weights);
  }
  if (weights.empty()) throw Error(Fault::kData, "it holds no layer with weights");
  return weights;
}

}  // namespace

CaffeWeights read_caffe_weights(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargestFile = 2047 << 20;  // as protobuf has it
  const std::string bytes = read_input_file(file, kLargestFile);
  try {
    return parse_network(std::as_bytes(std::span(bytes)));
  } catch (const Error& error) {
    throw Error(Fault::kData, std::string("not a complete .caffemodel: ") + error.what(),
                file.string(),
                "get the file again, and check that 'prototxt' and 'model' are not swapped");
  }
}

std::string shape_text(const std::vector<int>& shape) {
  std::string text;
  for (const int size : shape) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text.empty() ? "a single value" : text;
}

std::vector<int> shape_of(const cv::Mat& blob) { return {blob.size.p, blob.size.p + blob.dims}; }

}  // namespace stillpoint::segmenter_segnet
