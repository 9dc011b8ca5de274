// Segmenter `colours`: classes by their hue, where what matters is painted or worn in signal
// colours.
#pragma once

#include <stillpoint/sdk.hpp>
#include <string>
#include <vector>

/// What has such a colour is of this class. Hue is an angle on the colour circle: 0 is red, 60
/// yellow, 120 green, 240 blue.
struct ColourClass {
  std::string name;
  std::vector<double> hue = {0, 0};  ///< first and last, degrees
  double min_saturation = 0.35;      ///< 0 grey … 1
  double min_value = 0.15;           ///< 0 black … 1

  void visit(stillpoint::OptionVisitor& v);
};

class ColourSegmenter final : public stillpoint::Segmenter {
 public:
  struct Options {
    std::vector<ColourClass> classes = {{.name = "orange_vest", .hue = {10, 35}},
                                        {.name = "yellow_vest", .hue = {60, 100}}};
    int speckle = 1;       ///< px
    int gap = 4;           ///< px
    int min_pixels = 200;  ///< of an object

    void visit(stillpoint::OptionVisitor& v);
  };
  explicit ColourSegmenter(Options options) : options_(std::move(options)) {}

  /// Class ids follow the order of the option `classes`, from 1 on.
  stillpoint::ClassNames classes() const override;
  /// A pixel is of the first class that it fits.
  stillpoint::Segmentation segment(const stillpoint::Frame& frame) override;

 private:
  cv::Mat mask_of(const ColourClass& colour, const cv::Mat& hsv) const;

  Options options_;
};
