// The levels of a diagnostic status.
#pragma once

namespace diagnostic_msgs::msg {
struct DiagnosticStatus {
  enum : unsigned char { OK, WARN, ERROR, STALE };
};
}  // namespace diagnostic_msgs::msg
