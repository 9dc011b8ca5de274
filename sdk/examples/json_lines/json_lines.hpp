// Output `json_lines`: one JSON object per frame and line, for jq and other programs.
#pragma once

#include <cstdio>
#include <functional>
#include <memory>
#include <stillpoint/sdk.hpp>
#include <string>
#include <string_view>

/// Lines are written as frames come, so that they can be followed while the run goes on.
class JsonLines final : public stillpoint::Output {
 public:
  struct Options {
    std::string file = "frames.jsonl";

    void visit(stillpoint::OptionVisitor& v) {
      v("file", file, {.help = "from the run's folder; - for standard output"});
      v.require(!file.empty(), "file must have a name, or be -");
    }
  };

  JsonLines(const Options& options, const stillpoint::StageContext& context);

  /// Throws Error when the file cannot be made or written.
  void frame(const stillpoint::FrameReport& report) override;

 private:
  struct Close {
    void operator()(std::FILE* file) const {
      if (file != stdout) std::fclose(file);
    }
  };

  void open();

  std::string name_;  // of the file
  stillpoint::ClassNames classes_;
  std::function<void(stillpoint::LogLevel, std::string_view)> log_;
  bool to_standard_output_;
  bool opened_ = false;                     // at the first frame
  std::unique_ptr<std::FILE, Close> file_;  // null before, and when the reader has gone
};
