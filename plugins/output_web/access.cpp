#include "output_web/access.hpp"

#include <array>
#include <boost/asio/ip/address.hpp>
#include <cstdio>
#include <random>

namespace stillpoint::output_web {
namespace {

/// The name of "name:port" or "[::1]:port".
std::string_view name_of_host(std::string_view host) {
  const std::size_t end = host.starts_with('[') ? host.find(']') : host.find(':');
  if (end == std::string_view::npos) return host;
  return host.substr(0, host.starts_with('[') ? end + 1 : end);
}

bool is_local_name(std::string_view name) {
  return name == "localhost" || name == "[::1]" || is_loopback(std::string(name));
}

std::string_view token_in(std::string_view target) {
  constexpr std::string_view kKey = "token=";
  const std::size_t query = target.find('?');
  if (query == std::string_view::npos) return {};
  std::string_view rest = target.substr(query + 1);
  while (!rest.empty()) {
    const std::string_view field = rest.substr(0, rest.find('&'));
    if (field.starts_with(kKey)) return field.substr(kKey.size());
    rest.remove_prefix(std::min(rest.size(), field.size() + 1));
  }
  return {};
}

/// Takes the same time wherever the first difference is.
bool same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

bool is_of_host(std::string_view origin, std::string_view host) {
  for (const std::string_view scheme : {"http://", "https://"})
    if (origin.starts_with(scheme)) return origin.substr(scheme.size()) == host;
  return false;
}

}  // namespace

bool is_loopback(const std::string& address) {
  boost::system::error_code error;
  const auto parsed = boost::asio::ip::make_address(address, error);
  return !error && parsed.is_loopback();
}

std::string random_token() {
  std::random_device random;
  std::string token;
  for (int i = 0; i < 4; ++i) {
    std::array<char, 9> digits{};
    std::snprintf(digits.data(), digits.size(), "%08x", static_cast<unsigned>(random()));
    token += digits.data();
  }
  return token;
}

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

Access::Access(const std::string& address, std::string token)
    : loopback_(is_loopback(address)), token_(std::move(token)) {}

std::string_view Access::refusal(const RequestHead& head) const {
  if (loopback_ && !is_local_name(name_of_host(head.host)))
    return "this is not a name of the machine that runs Stillpoint";
  if (!head.origin.empty() && !is_of_host(head.origin, head.host))
    return "pages of other sites may not look";
  if (!token_.empty() && !same_secret(token_in(head.target), token_))
    return "the address lacks the right token; take the one that the run has printed";
  return {};
}

}  // namespace stillpoint::output_web
