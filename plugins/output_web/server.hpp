// The page and its messages over HTTP and WebSocket, on a thread of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stillpoint/sdk.hpp>
#include <string>
#include <string_view>

#include "output_web/access.hpp"
#include "output_web/event_log.hpp"

namespace stillpoint::output_web {

struct ServerSetup {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0: any that is free
  int viewers = 8;         ///< at once
  bool control = true;     ///< viewers may make the run do something
  Access access;
  std::string_view page;         ///< HTML; outlives the server
  std::filesystem::path record;  ///< a file that shows the run again; empty: none
  std::function<void(LogLevel, std::string_view)> log;
};

/// A viewer asks and is answered once something is new: one that does not read gets no data, and
/// the server never blocks. All requests are small and limited, and so is the time for them.
class Server {
 public:
  /// Throws Error(kUsage) when the address, the port or the file cannot be used.
  Server(ServerSetup setup, EventLog& events);
  /// Sends what is new and closes all connections, within half a second.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  /// The run that viewers may steer. From any thread, like notify(); neither waits.
  void begin(std::shared_ptr<LiveRun> run);
  /// The event log has something new.
  void notify();

 private:
  std::unique_ptr<class ServerLoop> loop_;
};

}  // namespace stillpoint::output_web
