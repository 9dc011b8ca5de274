#include "output_web/server_loop.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <boost/asio/post.hpp>
#include <string>
#include <utility>

#include "output_web/connection.hpp"
#include "output_web/viewer.hpp"

namespace stillpoint::output_web {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using namespace std::chrono_literals;

constexpr std::size_t kMostConnections = 64;
constexpr auto kCloseTimeout = 500ms;
constexpr auto kBetweenDenseMaps = 1s;
constexpr int kNice = 10;  // a tenth of tracking's share while both want to run

tcp::endpoint endpoint_of(const ServerSetup& setup) {
  error_code error;
  const auto address = asio::ip::make_address(setup.address, error);
  if (error)
    throw Error(Fault::kUsage, "'" + setup.address + "' is no address of this machine", "address",
                "give one in numbers, such as 127.0.0.1, or 0.0.0.0 for all");
  return {address, setup.port};
}

tcp::acceptor listening(asio::io_context& context, const ServerSetup& setup) {
  const tcp::endpoint endpoint = endpoint_of(setup);
  tcp::acceptor acceptor(context);
  error_code error;
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (!error) return acceptor;
  const std::string port = std::to_string(setup.port);
  if (error == asio::error::address_in_use)
    throw Error(Fault::kUsage, "port " + port + " is taken by another program", "port",
                "choose another one; 0 takes any that is free");
  throw Error(Fault::kUsage,
              "cannot listen at " + setup.address + ", port " + port + ": " + error.message(),
              "address");
}

}  // namespace

ServerLoop::ServerLoop(ServerSetup setup, EventLog& events)
    : setup_(std::move(setup)),
      events_(events),
      steering_(setup_.control, setup_.log),
      acceptor_(listening(context_, setup_)) {
  if (!setup_.record.empty()) recorder_.emplace(setup_.record, setup_.page);
  accept();
  thread_ = std::jthread([this] { work(); });
}

ServerLoop::~ServerLoop() {
  asio::post(context_, [this] { close_gracefully(); });
  thread_.join();
  close_timer_.reset();  // viewers that are left go with the context
}

void ServerLoop::begin(std::shared_ptr<LiveRun> run) {
  asio::post(context_, [this, run = std::move(run)] {
    steering_.begin(run);
    dense_map_.begin(run);
    tell_steering();
  });
}

void ServerLoop::notify() {
  if (!notified_.exchange(true)) asio::post(context_, [this] { offer_to_all(); });
}

void ServerLoop::leave(Viewer& viewer) {
  viewers_.erase(&viewer);
  if (steering_.leave(&viewer) && !closing_) tell_steering();
  error_code ignored;
  if (close_timer_ && viewers_.empty()) close_timer_->cancel(ignored);
}

bool ServerLoop::execute(Viewer& viewer, Command command) {
  if (!steering_.execute(&viewer, command)) return false;
  tell_steering();
  return true;
}

void ServerLoop::read_dense_map() {
  try {
    if (VoxelsPtr voxels = dense_map_.read()) events_.set_voxels(std::move(voxels));
  } catch (const std::exception& error) {  // of its plugin, whose run ends with it
    warn(error.what());
    dense_map_.begin(nullptr);
  }
  if (closing_) return;
  // It may have been busy, and grows while a paused run has no frames that would bring it.
  dense_map_timer_.expires_after(kBetweenDenseMaps);
  dense_map_timer_.async_wait([this](error_code cancelled) {
    if (!cancelled) notify();
  });
}

void ServerLoop::work() {
  const auto self = static_cast<id_t>(gettid());
  setpriority(PRIO_PROCESS, self, getpriority(PRIO_PROCESS, self) + kNice);
  for (;;) {
    try {
      context_.run();
      return;
    } catch (const std::exception& error) {  // of one connection, which is gone with it
      warn(std::string("a connection was dropped: ") + error.what());
    }
  }
}

void ServerLoop::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (!error) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);  // messages are whole
      if (connections_.size() + viewers_.size() < kMostConnections)
        std::make_shared<Connection>(*this, std::move(socket))->start();
      return accept();
    }
    retry_.expires_after(1s);  // no descriptors left, for instance
    retry_.async_wait([this](error_code cancelled) {
      if (!cancelled) accept();
    });
  });
}

void ServerLoop::offer_to_all() {
  notified_ = false;
  record(&Recorder::take);
  for (Viewer* viewer : viewers_) viewer->offer();
}

// Posted: a viewer that is about to go must not be offered anything.
void ServerLoop::tell_steering() {
  events_.set_steering(steering_.state());
  notify();
}

// A recording that fails costs nobody else anything.
void ServerLoop::record(void (Recorder::*what)(EventLog&)) {
  if (!recorder_) return;
  try {
    read_dense_map();
    ((*recorder_).*what)(events_);
  } catch (const std::exception& error) {
    warn(error.what());
    recorder_.reset();
  }
}

// The context runs dry once everybody has gone, or has had the time for it.
void ServerLoop::close_gracefully() {
  closing_ = true;
  acceptor_.close();
  retry_.cancel();
  dense_map_timer_.cancel();
  record(&Recorder::finish);
  for (Connection* connection : connections_) connection->cancel();
  if (viewers_.empty()) return;
  close_timer_.emplace(context_, kCloseTimeout);
  close_timer_->async_wait([this](error_code) { context_.stop(); });
  for (Viewer* viewer : viewers_) viewer->close_gracefully();
}

}  // namespace stillpoint::output_web
