// A viewer for tests, and strangers.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "output_web/message_writer.hpp"

namespace stillpoint::output_web {

/// Contents of a message's records, by kind.
using Records = std::map<Record, std::vector<std::string>>;

template <class T>
T number_at(const std::string& bytes, std::size_t place) {
  T value{};
  if (place + sizeof(T) > bytes.size()) throw std::out_of_range("behind the end of a record");
  std::memcpy(&value, bytes.data() + place, sizeof(T));
  return value;
}

inline Records records_of(const std::string& message) {
  Records records;
  if (number_at<std::uint8_t>(message, 0) != kProtocol) throw std::runtime_error("wrong protocol");
  for (std::size_t at = 1; at < message.size();) {
    const auto kind = static_cast<Record>(number_at<std::uint8_t>(message, at));
    const auto size = number_at<std::uint32_t>(message, at + 1);
    if (at + 5 + size > message.size()) throw std::out_of_range("a record is cut off");
    records[kind].push_back(message.substr(at + 5, size));
    at += 5 + size;
  }
  return records;
}

/// Of a page's URL, "http://127.0.0.1:PORT/…".
inline std::uint16_t port_of(const std::string& url) {
  const std::size_t colon = url.rfind(':');
  return static_cast<std::uint16_t>(std::stoi(url.substr(colon + 1)));
}

/// A connection over which a test sends what it likes.
class TestConnection {
 public:
  explicit TestConnection(std::uint16_t port) {
    namespace ip = boost::asio::ip;
    stream_.connect(ip::tcp::endpoint(ip::make_address("127.0.0.1"), port));
  }
  void send(std::string_view bytes) {
    boost::system::error_code ignored;  // the server may have closed it already
    boost::asio::write(stream_, boost::asio::buffer(bytes.data(), bytes.size()), ignored);
  }
  /// Nothing more will be sent.
  void end() {
    boost::system::error_code ignored;
    stream_.shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  }
  /// All that comes until the server closes.
  std::string rest() {
    std::string text;
    boost::system::error_code end;
    boost::asio::read(stream_, boost::asio::dynamic_buffer(text), end);
    return text;
  }

 private:
  boost::asio::io_context context_;
  boost::asio::ip::tcp::socket stream_{context_};
};

/// The answer to a request, as text with its headers.
inline std::string answer_to(std::uint16_t port, const std::string& request) {
  TestConnection connection(port);
  connection.send(request);
  connection.end();
  return connection.rest();
}

inline std::string get(std::uint16_t port, const std::string& target,
                       const std::string& headers = "Host: localhost\r\n") {
  return answer_to(port, "GET " + target + " HTTP/1.1\r\n" + headers + "\r\n");
}

/// A page that looks.
class TestViewer {
 public:
  /// `receive_buffer`: bytes that wait unread in this computer; 0: as many as it likes.
  explicit TestViewer(std::uint16_t port, const std::string& target = "/live",
                      int receive_buffer = 0) {
    namespace ip = boost::asio::ip;
    socket_.next_layer().open(ip::tcp::v4());
    if (receive_buffer > 0)
      socket_.next_layer().set_option(ip::tcp::socket::receive_buffer_size(receive_buffer));
    socket_.next_layer().connect(ip::tcp::endpoint(ip::make_address("127.0.0.1"), port));
    socket_.next_layer().set_option(ip::tcp::no_delay(true));
    socket_.binary(true);
    socket_.handshake("localhost", target);
  }

  void send(const std::string& bytes) { socket_.write(boost::asio::buffer(bytes)); }
  /// 1 image, 2 map, 4 surfaces.
  void ask(std::uint8_t bits = 7) {
    send({static_cast<char>(kProtocol), 1, static_cast<char>(bits)});
  }
  /// Waits for the next message; nothing when the server has said good-bye.
  std::optional<Records> next() {
    boost::beast::flat_buffer buffer;
    boost::system::error_code error;
    socket_.read(buffer, error);
    if (error) return std::nullopt;
    return records_of(boost::beast::buffers_to_string(buffer.data()));
  }
  std::optional<Records> asked(std::uint8_t bits = 7) {
    ask(bits);
    return next();
  }
  /// After next() gave nothing.
  std::uint16_t close_code() const { return socket_.reason().code; }

 private:
  boost::asio::io_context context_;
  boost::beast::websocket::stream<boost::asio::ip::tcp::socket> socket_{context_};
};

}  // namespace stillpoint::output_web
