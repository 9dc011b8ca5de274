#include "stillpoint/support/image_codec.hpp"

#include <dlfcn.h>

#include <atomic>
#include <filesystem>

#include "../image_codec/codec_functions.hpp"
#include "../image_codec/codec_loading.hpp"
#include "../loader_message.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/model_lookup.hpp"

namespace stillpoint {
namespace {

void load_directly(void (*load)()) { load(); }

std::atomic<void (*)(void (*load)())> around_loading{&load_directly};

const CodecFunctions* loaded_functions = nullptr;

void load_codec();

/// In the folder `stillpoint` beside this library; looked up before files can be exchanged.
const std::filesystem::path codec_file =
    folder_of(reinterpret_cast<const void*>(&load_codec)) / "stillpoint" / kCodecLibrary;

void load_codec() {
  const std::string file = codec_file.string();
  // A name without a folder would be looked for in other places.
  void* library =
      codec_file.is_absolute() ? ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL) : nullptr;
  const auto functions_of =
      library ? reinterpret_cast<const CodecFunctions* (*)()>(::dlsym(library, kCodecSymbol))
              : nullptr;
  if (!functions_of)
    throw Error(Fault::kUsage, "cannot be loaded: " + loader_message(file), file,
                "images need it; it is a part of Stillpoint: install it again");
  loaded_functions = functions_of();
}

const CodecFunctions& codec() {
  static const CodecFunctions functions = [] {
    around_loading.load()(&load_codec);
    return *loaded_functions;
  }();
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

void load_image_codec_with(void (*around)(void (*load)())) { around_loading = around; }

}  // namespace stillpoint
