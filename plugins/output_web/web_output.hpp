// A live view of the run in browsers.
#pragma once

#include <stillpoint/sdk.hpp>
#include <string>

#include "output_web/event_log.hpp"
#include "output_web/server.hpp"

namespace stillpoint::output_web {

class WebOutput final : public Output {
 public:
  struct Options {
    int port = 8080;
    std::string address = "127.0.0.1";
    std::string token;
    int viewers = 8;
    bool control = true;
    std::string record;

    void visit(OptionVisitor& v) {
      v("port", port,
        {.min = 0, .max = 65535, .help = "TCP port of the page; 0: any that is free"});
      v("address", address,
        {.help = "IP address of this machine to listen on; 127.0.0.1: for this machine only; "
                 "0.0.0.0: also for others"});
      v("token", token,
        {.help = "secret word that the address of the page must end in, as in ?token=WORD; empty: "
                 "none for 127.0.0.1, a random one otherwise"});
      v("viewers", viewers,
        {.min = 1,
         .max = 32,
         .help = "browsers that may watch at the same time; more are turned away"});
      v("control", control, {.help = "viewers may pause and end the run, and have its map saved"});
      v("record", record,
        {.help = "name of a page in the run folder that shows the run again, such as live.html; "
                 "empty: none"});
    }
  };
  /// Throws Error(kUsage) when address, port or file cannot be used, or the token has other
  /// characters than letters, digits, '-' and '_'.
  WebOutput(const Options& options, const StageContext& context);

  void begin(const std::shared_ptr<LiveRun>& run) override;
  void frame(const FrameReport& report) override;
  void finish(const RunSummary& summary) override;
  void ended_before_first_frame(const RunSummary& summary) override { finish(summary); }

  /// What a browser is to open, token included.
  const std::string& url() const { return url_; }

 private:
  WebOutput(const Options& options, const StageContext& context, const std::string& token);

  EventLog events_;
  Server server_;  // last: it uses the event log
  std::string url_;
};

}  // namespace stillpoint::output_web
