#include "output_web/server.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "output_web/message_writer.hpp"

namespace stillpoint::output_web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using namespace std::chrono_literals;

constexpr std::uint32_t kHeaderLimit = 8192;  // bytes of an HTTP request
constexpr std::size_t kMostConnections = 64;
constexpr auto kRequestTime = 10s;
constexpr auto kIdleTime = 30s;  // until a viewer that does not answer to pings has gone
constexpr auto kFarewell = 500ms;
constexpr int kNice = 10;  // a tenth of tracking's share while both want to run

// The page has all of itself within: nothing is loaded from elsewhere.
constexpr const char* kContentPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; connect-src 'self'; base-uri 'none'; frame-ancestors 'none'";

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

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

/// All of it runs on one thread, but for notify().
class Server::Loop {
 public:
  Loop(ServerSetup setup, Journal& journal)
      : setup_(std::move(setup)), journal_(journal), acceptor_(listening(context_, setup_)) {
    accept();
    thread_ = std::jthread([this] { work(); });
  }
  ~Loop() {
    asio::post(context_, [this] { say_goodbye(); });
    thread_.join();
    farewell_.reset();  // viewers that are left go with the context
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  std::uint16_t port() const { return port_; }
  void notify() {
    if (!notified_.exchange(true)) asio::post(context_, [this] { offer_to_all(); });
  }

 private:
  class Connection;
  class Viewer;

  void work();
  void accept();
  void offer_to_all();
  void say_goodbye();

  const ServerSetup setup_;
  Journal& journal_;
  std::set<Connection*> connections_;  // they leave by themselves, at the latest with the context
  std::set<Viewer*> viewers_;
  asio::io_context context_{1};
  tcp::acceptor acceptor_;
  const std::uint16_t port_ = acceptor_.local_endpoint().port();
  asio::steady_timer retry_{context_};
  std::optional<asio::steady_timer> farewell_;  // once it has begun
  std::atomic<bool> notified_ = false;
  std::jthread thread_;  // last: it uses all the others
};

/// A browser with the page open. It asks, and gets one message.
class Server::Loop::Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(Loop& loop, beast::tcp_stream stream) : loop_(loop), socket_(std::move(stream)) {
    loop_.viewers_.insert(this);
  }
  ~Viewer() {
    loop_.viewers_.erase(this);
    error_code ignored;
    if (loop_.farewell_ && loop_.viewers_.empty()) loop_.farewell_->cancel(ignored);
  }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  void start(const http::request<http::empty_body>& request) {
    beast::get_lowest_layer(socket_).expires_never();  // the socket has time limits of its own
    socket_.set_option(websocket::stream_base::timeout{
        .handshake_timeout = kRequestTime, .idle_timeout = kIdleTime, .keep_alive_pings = true});
    socket_.read_message_max(kRequestSize);
    socket_.binary(true);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->open_ = true;
      self->read();
    });
  }

  /// Answers if it has asked, and something is new.
  void offer() {
    if (asked_) send(*asked_);
  }

  void say_goodbye() {
    if (!open_) return beast::get_lowest_layer(socket_).cancel();
    send({.image = true, .map = true, .cloud = true});
    if (!writing_) close(websocket::close_code::going_away);
  }

 private:
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error) self->take_request();
    });
  }

  // Who asks again before an answer has come, or something that nobody may ask, is no page of ours.
  void take_request() {
    const auto bytes = buffer_.cdata();
    const auto request =
        parse_request({static_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    if (!request || asked_ || !socket_.got_binary())
      return close(websocket::close_code::policy_error);
    buffer_.consume(buffer_.size());
    asked_ = request;
    offer();
    read();
  }

  void send(const Request& request) {
    if (writing_ || closed_) return;
    message_ = loop_.journal_.news(seen_, request);
    if (message_.empty()) return;
    writing_ = true;
    asked_.reset();
    socket_.async_write(asio::buffer(message_),
                        [self = shared_from_this()](error_code error, std::size_t) {
                          if (!error) self->written();
                        });
  }

  void written() {
    writing_ = false;
    if (loop_.farewell_) return say_goodbye();
    offer();
  }

  void close(websocket::close_code reason) {
    if (std::exchange(closed_, true)) return;
    socket_.async_close(reason, [self = shared_from_this()](error_code) {});
  }

  Loop& loop_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  std::string message_;  // under way
  Seen seen_;
  std::optional<Request> asked_;
  bool open_ = false;  // the handshake is over
  bool writing_ = false;
  bool closed_ = false;
};

/// One HTTP request: the page, or a viewer's beginning.
class Server::Loop::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Loop& loop, tcp::socket socket) : loop_(loop), stream_(std::move(socket)) {
    loop_.connections_.insert(this);
  }
  ~Connection() { loop_.connections_.erase(this); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void start() {
    stream_.expires_after(kRequestTime);
    parser_.header_limit(kHeaderLimit);
    parser_.body_limit(std::uint64_t{0});
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](error_code error, std::size_t) {
                       if (!error) self->answer();
                     });
  }
  void cancel() { stream_.cancel(); }

 private:
  void answer() {
    const auto& request = parser_.get();
    const std::string_view target = view_of(request.target());
    const std::string_view refusal =
        loop_.setup_.access.refusal({.target = target,
                                     .host = view_of(request[http::field::host]),
                                     .origin = view_of(request[http::field::origin])});
    if (!refusal.empty()) return respond(http::status::forbidden, refusal);
    if (path_of(target) == "/live" && websocket::is_upgrade(request)) return become_viewer();
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return respond(http::status::method_not_allowed, "only GET");
    if (path_of(target) != "/") return respond(http::status::not_found, "there is only /");
    respond(http::status::ok, loop_.setup_.page, "text/html; charset=utf-8");
  }

  void become_viewer() {
    if (loop_.viewers_.size() >= static_cast<std::size_t>(loop_.setup_.viewers))
      return respond(http::status::service_unavailable, "as many viewers as the run allows");
    std::make_shared<Viewer>(loop_, std::move(stream_))->start(parser_.get());
  }

  void respond(http::status status, std::string_view text,
               const char* type = "text/plain; charset=utf-8") {
    response_.emplace();
    response_->result(status);
    response_->set(http::field::content_type, type);
    response_->set(http::field::cache_control, "no-store");
    response_->set("Content-Security-Policy", kContentPolicy);
    response_->set("X-Content-Type-Options", "nosniff");
    response_->set("Referrer-Policy", "no-referrer");  // the address may have the token
    response_->content_length(text.size());
    response_->keep_alive(false);
    if (parser_.get().method() != http::verb::head) response_->body() = {text.data(), text.size()};
    http::async_write(stream_, *response_, [self = shared_from_this()](error_code, std::size_t) {
      error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  Loop& loop_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kHeaderLimit};
  http::request_parser<http::empty_body> parser_;
  std::optional<http::response<http::span_body<const char>>> response_;
};

void Server::Loop::work() {
  const auto self = static_cast<id_t>(gettid());
  setpriority(PRIO_PROCESS, self, getpriority(PRIO_PROCESS, self) + kNice);
  for (;;) {
    try {
      context_.run();
      return;
    } catch (const std::exception& error) {  // of one viewer, who is gone with it
      setup_.log(LogLevel::kWarning, std::string("a viewer was dropped: ") + error.what());
    }
  }
}

void Server::Loop::accept() {
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

void Server::Loop::offer_to_all() {
  notified_ = false;
  for (Viewer* viewer : viewers_) viewer->offer();
}

// The context runs dry once everybody has gone, or has had the time for it.
void Server::Loop::say_goodbye() {
  acceptor_.close();
  retry_.cancel();
  for (Connection* connection : connections_) connection->cancel();
  if (viewers_.empty()) return;
  farewell_.emplace(context_, kFarewell);
  farewell_->async_wait([this](error_code) { context_.stop(); });
  for (Viewer* viewer : viewers_) viewer->say_goodbye();
}

Server::Server(ServerSetup setup, Journal& journal)
    : loop_(std::make_unique<Loop>(std::move(setup), journal)) {}

Server::~Server() = default;

std::uint16_t Server::port() const { return loop_->port(); }

void Server::notify() { loop_->notify(); }

}  // namespace stillpoint::output_web
