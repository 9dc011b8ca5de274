#include "output_web/web_output.hpp"

#include <algorithm>
#include <utility>

#include "output_web/page.hpp"

namespace stillpoint::output_web {
namespace {

bool is_token_letter(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
         (letter >= '0' && letter <= '9') || letter == '-' || letter == '_';
}

std::string token_of(const WebOutput::Options& options) {
  if (!std::ranges::all_of(options.token, is_token_letter))
    throw Error(Fault::kUsage, "it has other characters than letters, digits, '-' and '_'", "token",
                "leave it out for a random one");
  if (options.token.empty() && !is_loopback(options.address)) return random_token();
  return options.token;
}

std::string name_of(const std::filesystem::path& recording) {
  if (recording.empty()) return "";
  return (recording.has_filename() ? recording : recording.parent_path()).filename().string();
}

std::string url_of(const std::string& address, std::uint16_t port, const std::string& token) {
  const std::string host = address.find(':') == std::string::npos ? address : '[' + address + ']';
  return "http://" + host + ':' + std::to_string(port) + '/' +
         (token.empty() ? "" : "?token=" + token);
}

ServerSetup setup_of(const WebOutput::Options& options, const StageContext& context,
                     const std::string& token) {
  return {.address = options.address,
          .port = static_cast<std::uint16_t>(options.port),
          .viewers = options.viewers,
          .control = options.control,
          .access = Access(options.address, token),
          .page = page(),
          .record = options.record.empty() ? "" : context.output_directory / options.record,
          .log = context.log};
}

}  // namespace

WebOutput::WebOutput(const Options& options, const StageContext& context)
    : WebOutput(options, context, token_of(options)) {}

WebOutput::WebOutput(const Options& options, const StageContext& context, const std::string& token)
    : events_({.name = name_of(context.recording),
               .classes = context.classes,
               .truth = Truth::beside(context.recording)}),
      server_(setup_of(options, context, token), events_),
      url_(url_of(options.address, server_.port(), token)) {
  context.log(LogLevel::kInfo, "live view at " + url_);
}

void WebOutput::begin(const std::shared_ptr<LiveRun>& run) { server_.begin(run); }

void WebOutput::frame(const FrameReport& report) {
  events_.add(report);
  server_.notify();
}

void WebOutput::finish(const RunSummary& summary) {
  events_.finish(summary);
  server_.notify();
}

}  // namespace stillpoint::output_web
