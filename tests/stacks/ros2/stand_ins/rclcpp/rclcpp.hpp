// What the driver of ros2_canopen uses of rclcpp: it prints its messages.
#pragma once
#include <cstdio>
#include <iostream>
#include <map>
#include <string>

namespace rclcpp {
inline std::string get_logger(const std::string& name) { return name; }
}  // namespace rclcpp

#define RCLCPP_SAY(logger, ...) \
  (std::fprintf(stderr, "%s: ", (logger).c_str()), std::fprintf(stderr, __VA_ARGS__), std::fputc('\n', stderr))
#define RCLCPP_DEBUG RCLCPP_SAY
#define RCLCPP_INFO RCLCPP_SAY
#define RCLCPP_WARN RCLCPP_SAY
#define RCLCPP_ERROR RCLCPP_SAY
