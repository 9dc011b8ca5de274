// Pipeline files, and the plugins that they name.
#include "fuzz/fuzz_target.hpp"
#include "stillpoint/runtime/plugin_stamp.hpp"
#include "stillpoint/runtime/yaml_loader.hpp"

namespace stillpoint::testing {
namespace {

FuzzTarget plugin_stamp() {
  return {.seeds = {bytes_of(fs::path(STILLPOINT_BINARY_DIR) /
                             "tests/plugins_bad/plugins/libstillpoint_good.so")},
          .parse = [](const fs::path& file) { why_library_does_not_fit(file); },
          .words = {"\x7f"
                    "ELF",
                    "stillpoint_plugin_stamp", "api 99999999999\n", "abi \n"}};
}

FuzzTarget configuration() {
  return {
      .seeds = {bytes_of_text("version: 1\nextends: " STILLPOINT_SOURCE_DIR
                              "/configs/pipelines/stillpoint.yaml\ncamera: tum_fr1\n"
                              "source: &s {type: tum_rgbd, path: \"${HOME}\"}\n"
                              "outputs: [{type: images, of: [1, 2]}]\n"
                              "tracker:\n  features: 1000\n  text: |\n    a\n    b\n")},
      .parse =
          [](const fs::path& file) {
            FaultList faults;
            ConfigNode node = load_config_file(file, "pipelines", faults);
            substitute_environment(node, faults);
            faults.throw_if_any();
          },
      .words = {"extends: ", "&a ", "*a",     "*s", "<<: ", "- ",    "{",     "}",           "[",
                "]",         "? ",  "!!str ", "|",  ">",    "---\n", "...\n", "%YAML 1.2\n", "${",
                "}",         ": ",  "\n  ",   ", ", "'",    "\"",    "\\x"}};
}

}  // namespace

std::vector<NamedFuzzTarget> configuration_targets() {
  return {{"PluginStamp", plugin_stamp}, {"Configuration", configuration}};
}

}  // namespace stillpoint::testing
