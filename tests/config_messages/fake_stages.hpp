// Stages that do nothing, with options of every form, linked into the tests.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "stillpoint/engine/registry.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint {

struct FakeSource final : Source {
  struct Options {
    std::string path;
    double max_difference = 0.02;
    void visit(OptionVisitor& v) {
      v("path", path, {.help = "folder of the recording", .required = true, .is_path = true});
      v("max_difference", max_difference, {.min = 0, .unit = "s", .help = "between the images"});
    }
  };
  explicit FakeSource(const Options& o) : options(o) {}
  std::optional<Frame> next() override { return std::nullopt; }
  std::filesystem::path ground_truth() const override { return options.path; }
  Options options;
};

struct PathlessSource final : Source {
  std::optional<Frame> next() override { return std::nullopt; }
};

struct FakeChecker final : MovingChecker {
  struct Options {
    double epsilon = 1.0;
    int max_corners = 1000;
    void visit(OptionVisitor& v) {
      v("epsilon", epsilon, {.min = 0, .unit = "px", .help = "farther than this is moving"});
      v("max_corners", max_corners, {.min = 8, .max = 100000, .help = "corners followed"});
    }
  };
  explicit FakeChecker(const Options&) {}
  MovingPoints check(const Frame&, const Frame&, const TrackingHistory&) override { return {}; }
};

struct FakeDecision final : Decision {
  struct Class {
    double prior = 0.5;
    bool keep = true;
    void visit(OptionVisitor& v) {
      v("prior", prior, {.min = 0, .max = 1, .help = "probability of moving"});
      v("keep", keep, {.help = "in the map"});
    }
  };
  struct Region {
    std::string name;
    std::vector<double> box = {0, 0, 1, 1};
    void visit(OptionVisitor& v) {
      v("name", name, {.help = "for messages", .required = true});
      v("box", box, {.min = 0, .max = 1, .help = "x, y, width, height"});
    }
  };
  struct Options {
    std::vector<std::string> labels = {"person"};
    std::map<std::string, Class> classes = {{"person", {.prior = 0.9}}};
    std::vector<Region> regions = {{.name = "left \"half\"", .box = {0, 0, 0.5, 1}}};
    Class other;
    enum class Rule { kAny, kMost } rule = Rule::kAny;
    void visit(OptionVisitor& v) {
      v("labels", labels, {.help = "that can move"});
      v("classes", classes, {.help = "by name"});
      v("regions", regions, {.help = "parts of the image"});
      v("other", other, {.help = "classes that are not named"});
      v.choice("rule", rule, {{"any", Rule::kAny}, {"most", Rule::kMost}}, {.help = "of the vote"});
      v.require(rule == Rule::kAny || !labels.empty(), "rule 'most' needs labels");
    }
  };
  explicit FakeDecision(const Options& o) : options(o) {}
  StaticWeights decide(const Frame&, const Segmentation&, const MovingPoints&,
                       const MapEvidence&) override {
    return {};
  }
  Options options;
};

struct FakeSegmenter final : Segmenter {
  struct Options {
    std::string model = "small.onnx";
    double scale = 1;
    void visit(OptionVisitor& v) {
      v("model", model, {.help = "a network", .is_path = true});
      v("scale", scale, {.help = "of the input"});
    }
  };
  explicit FakeSegmenter(const Options& o) : options(o) {}
  ClassNames classes() const override { return {"background", options.model}; }
  Segmentation segment(const Frame&) override { return {}; }
  Options options;
};

struct FakeOutput final : Output {
  struct Options {
    std::string format = "tum";
    void visit(OptionVisitor& v) { v("format", format, {.help = "of the file"}); }
  };
  explicit FakeOutput(const Options&) { throw std::runtime_error("the disk is full"); }
};

inline constexpr PluginEntry kEntries[] = {
    provide<Source, FakeSource>("tum_rgbd", "a recording"),
    provide<Source, FakeSource>("bag", "a bag"),
    provide<Source, FakeSource>("own", "another recording"),
    provide<Source, PathlessSource>("simulation", "a made-up world"),
    provide<Segmenter, FakeSegmenter>("opencv_dnn", "a network"),
    provide<MovingChecker, FakeChecker>("lk_epipolar", "optical flow"),
    provide<MovingChecker, FakeChecker>("lk_usac", "optical flow"),
    provide<Decision, FakeDecision>("object_vote", "votes of moving points"),
    provide<Output, FakeOutput>("trajectory", "poses"),
};
inline constexpr PluginDescriptor kFakePlugin = {"fake", "1.0", kEntries, std::size(kEntries)};

}  // namespace stillpoint
