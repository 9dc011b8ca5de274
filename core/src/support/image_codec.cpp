#include "stillpoint/support/image_codec.hpp"

#include <dlfcn.h>

#include <atomic>
#include <filesystem>
#include <string_view>

#include "../image_codec/codec_functions.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/model_lookup.hpp"

namespace stillpoint {
namespace {

std::atomic<void (*)()> when_loaded{nullptr};

/// What dlopen() or dlsym() said, without the file's name before it.
std::string loader_message(const std::string& file) {
  const char* said = ::dlerror();
  std::string_view text = said ? said : "for no known reason";
  if (text.starts_with(file + ": ")) text.remove_prefix(file.size() + 2);
  return std::string(text);
}

CodecFunctions load_codec() {
  const void* own_code = reinterpret_cast<const void*>(&load_codec);
  const std::filesystem::path file = folder_of(own_code) / "stillpoint" / kCodecLibrary;
  void* library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  const auto functions_of =
      library ? reinterpret_cast<const CodecFunctions* (*)()>(::dlsym(library, kCodecSymbol))
              : nullptr;
  if (!functions_of)
    throw Error(Fault::kUsage, "cannot be loaded: " + loader_message(file.string()), file.string(),
                "images need it; it is a part of Stillpoint: install it again");
  const CodecFunctions functions = *functions_of();
  if (const auto loaded = when_loaded.load()) loaded();
  return functions;
}

const CodecFunctions& codec() {
  static const CodecFunctions functions = load_codec();
  return functions;
}

}  // namespace

cv::Mat decode_image(std::span<const std::uint8_t> file, int imread_flags) {
  return codec().decode(file, imread_flags);
}

std::vector<std::uint8_t> encode_image(const std::string& extension, const cv::Mat& image,
                                       const std::vector<int>& imwrite_options) {
  std::vector<std::uint8_t> file = codec().encode(extension, image, imwrite_options);
  if (file.empty()) throw Error(Fault::kUsage, "an image cannot be encoded as " + extension);
  return file;
}

void when_image_codec_is_loaded(void (*loaded)()) { when_loaded = loaded; }

}  // namespace stillpoint
