// HOST:PORT as options take it.
#pragma once

#include <optional>
#include <string>

namespace wavecrest {

struct HostPort {
  std::string host;
  int port = 0;  // 0: any that is free, for who listens

  std::string text() const;  // an IPv6 address in brackets
};

// PORT, :PORT, HOST:PORT or [IPv6]:PORT; a host that is left out is this machine, 127.0.0.1. Nothing where the text is
// none of them. A port is 0 to 65535.
std::optional<HostPort> parseHostPort(const std::string& text);

// Whether only programs on this machine reach the host.
bool isLoopback(const std::string& host);

}  // namespace wavecrest
