// Output `my_plugin`: one line of CSV per frame.
#pragma once

#include <stillpoint/sdk.hpp>
#include <stillpoint/support/atomic_file.hpp>
#include <string>

namespace plugins::my_plugin {

class MyPlugin final : public stillpoint::Output {
 public:
  struct Options {
    std::string file = "my_plugin.csv";
    int every = 1;

    void visit(stillpoint::OptionVisitor& v);
  };

  /// Throws Error when the file cannot be made.
  MyPlugin(const Options& options, const stillpoint::StageContext& context);

  void frame(const stillpoint::FrameReport& report) override;
  void finish(const stillpoint::RunSummary& summary) override;

 private:
  Options options_;
  stillpoint::AtomicFile file_;  // there once it is complete
};

}  // namespace plugins::my_plugin
