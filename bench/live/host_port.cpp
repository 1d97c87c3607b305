#include "bench/live/host_port.h"

#include "bench/whole_number.h"

namespace wavecrest {
namespace {

std::optional<int> parsePort(const std::string& text) {
  const std::optional<int> port = wholeNumber<int>(text);
  return port && *port >= 0 && *port <= 65535 ? port : std::nullopt;
}

}  // namespace

std::string HostPort::text() const {
  return (host.find(':') == std::string::npos ? host : "[" + host + "]") + ":" + std::to_string(port);
}

std::optional<HostPort> parseHostPort(const std::string& text) {
  const size_t colon = text.rfind(':');
  const std::optional<int> port = parsePort(colon == std::string::npos ? text : text.substr(colon + 1));
  if (!port) return std::nullopt;
  std::string host = colon == std::string::npos ? "" : text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string::npos) {
    return std::nullopt;
  }
  return HostPort{.host = host.empty() ? "127.0.0.1" : host, .port = *port};
}

bool isLoopback(const std::string& host) { return host == "localhost" || host == "::1" || host.starts_with("127."); }

}  // namespace wavecrest
