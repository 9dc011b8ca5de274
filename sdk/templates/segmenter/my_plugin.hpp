// Segmenter `my_plugin`: labels what has a certain colour.
#pragma once

#include <stillpoint/sdk.hpp>
#include <string>

namespace plugins::my_plugin {

class MyPlugin final : public stillpoint::Segmenter {
 public:
  struct Options {
    std::string class_name = "person";
    int min_hue = 60;  // degrees: 0 red, 60 yellow, 120 green, 240 blue
    int max_hue = 100;
    int min_saturation = 100;
    int min_value = 50;
    int min_pixels = 50;

    void visit(stillpoint::OptionVisitor& v);
  };

  explicit MyPlugin(Options options) : options_(std::move(options)) {}

  stillpoint::ClassNames classes() const override { return {"background", options_.class_name}; }
  stillpoint::Segmentation segment(const stillpoint::Frame& frame) override;

 private:
  Options options_;
};

}  // namespace plugins::my_plugin
