// Who may look: pages of other sites may not, and nobody without the token where there is one.
#pragma once

#include <string>
#include <string_view>

namespace stillpoint::output_web {

/// 127.0.0.0/8 or ::1: only programs on this machine, and those behind an ssh tunnel, get there.
bool is_loopback(const std::string& address);

/// 128 random bits from the system, in hexadecimal.
std::string random_token();

/// Of an HTTP request, as they came.
struct RequestHead {
  std::string_view target;  ///< "/live?token=…"
  std::string_view host;    ///< the header; empty: none
  std::string_view origin;  ///< the header, which browsers set; empty: none
};

/// "/live" of "/live?token=…".
std::string_view path_of(std::string_view target);

class Access {
 public:
  /// An empty token is not asked for.
  Access(const std::string& address, std::string token);

  /// Empty: allowed. Otherwise the reason why not.
  ///
  /// Without a token, the host must be a name of this machine: a site whose name is made to lead
  /// here (DNS rebinding) still calls itself by that name. An origin, where there is one, must be
  /// the host itself. The port may be any, because tunnels change it.
  std::string_view refusal(const RequestHead& head) const;

 private:
  const bool loopback_;
  const std::string token_;
};

}  // namespace stillpoint::output_web
