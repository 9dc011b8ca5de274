// The server's thread, and who is connected to it.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <thread>

#include "output_web/dense_map_reader.hpp"
#include "output_web/recorder.hpp"
#include "output_web/server.hpp"
#include "output_web/steering.hpp"

namespace stillpoint::output_web {

class Connection;
class Viewer;

inline constexpr auto kRequestTime = std::chrono::seconds(10);  // that a request may take

/// begin() and notify() may be called from any thread; connections and viewers use the rest, on the
/// thread of the loop.
class ServerLoop {
 public:
  ServerLoop(ServerSetup setup, EventLog& events);
  ~ServerLoop();
  ServerLoop(const ServerLoop&) = delete;
  ServerLoop& operator=(const ServerLoop&) = delete;

  std::uint16_t port() const { return port_; }
  void begin(std::shared_ptr<LiveRun> run);
  void notify();

  const ServerSetup& setup() const { return setup_; }
  EventLog& events() { return events_; }
  bool is_full() const { return viewers_.size() >= static_cast<std::size_t>(setup_.viewers); }
  bool is_closing() const { return closing_; }
  void enter(Connection& connection) { connections_.insert(&connection); }
  void leave(Connection& connection) { connections_.erase(&connection); }
  void enter(Viewer& viewer) { viewers_.insert(&viewer); }
  void leave(Viewer& viewer);
  /// False where viewers may only look.
  bool execute(Viewer& viewer, Command command);
  /// A viewer wants to see it, and is offered it again in a second.
  void read_dense_map();
  void warn(std::string_view text) const { setup_.log(LogLevel::kWarning, text); }

 private:
  void work();
  void accept();
  void offer_to_all();
  void tell_steering();
  void record(void (Recorder::*what)(EventLog&));
  void close_gracefully();

  const ServerSetup setup_;
  EventLog& events_;
  Steering steering_;
  DenseMapReader dense_map_;
  std::optional<Recorder> recorder_;
  std::set<Connection*> connections_;  // they leave by themselves, at the latest with the context
  std::set<Viewer*> viewers_;
  bool closing_ = false;
  std::optional<boost::asio::steady_timer> close_timer_;  // gone before the context
  boost::asio::io_context context_{1};
  boost::asio::ip::tcp::acceptor acceptor_;
  const std::uint16_t port_ = acceptor_.local_endpoint().port();
  boost::asio::steady_timer retry_{context_};
  boost::asio::steady_timer dense_map_timer_{context_};
  std::atomic<bool> notified_ = false;
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace stillpoint::output_web
