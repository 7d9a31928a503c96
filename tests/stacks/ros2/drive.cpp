// The driver of ros2_canopen for drives, on the master of Lely core, commands a drive behind slcan over TCP.
//
//     ros2-drive SLCAN_PORT CONTROL_PORT MASTER.dcf DRIVE.eds DRIVE.bin
//
// The classes Motor402 and LelyDriverBridge are those of ros2_canopen; what they use of ROS is in `stand_ins`. This file does
// what the node of ros2_canopen does with them: it boots the drive, reads and writes every 10 ms, and calls a service for
// each step. It prints `ok` or `failed` for each step.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cinttypes>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <lely/coapp/master.hpp>
#include <lely/ev/loop.hpp>
#include <lely/io2/posix/poll.hpp>
#include <lely/io2/sys/clock.hpp>
#include <lely/io2/sys/io.hpp>
#include <lely/io2/sys/timer.hpp>
#include <lely/io2/user/can.hpp>
#include <thread>

#include "canopen_402_driver/motor.hpp"

using namespace std::chrono_literals;
using namespace ros2_canopen;

static int connected(const char* port) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(std::atoi(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  int own = socket(AF_INET, SOCK_STREAM, 0);
  if (connect(own, reinterpret_cast<sockaddr*>(&to), sizeof(to))) {
    std::perror("connect");
    std::exit(2);
  }
  return own;
}

static void say(int to, const std::string& text) {
  if (write(to, text.data(), text.size()) != static_cast<ssize_t>(text.size())) std::exit(2);
}

// Lely core sends a frame: as a line of slcan.
static int send_frame(const can_msg* msg, int, void* link) {
  char line[64];
  int used = std::snprintf(line, sizeof(line), "%c%03" PRIX32 "%d", msg->flags & CAN_FLAG_RTR ? 'r' : 't', msg->id, msg->len);
  for (int at = 0; at < msg->len && !(msg->flags & CAN_FLAG_RTR); at++)
    used += std::snprintf(line + used, sizeof(line) - used, "%02X", msg->data[at]);
  say(*static_cast<int*>(link), std::string(line, used) + "\r");
  return 0;
}

// Hands each line of slcan to Lely core.
static void receive_frames(int link, lely::io::UserCanChannel& channel) {
  std::string line;
  char byte;
  while (read(link, &byte, 1) == 1) {
    if (byte != '\r' && byte != '\a') {
      line += byte;
      continue;
    }
    if (line.size() >= 5 && (line[0] == 't' || line[0] == 'r')) {
      can_msg msg = CAN_MSG_INIT;
      msg.id = std::stoul(line.substr(1, 3), nullptr, 16);
      msg.len = line[4] - '0';
      msg.flags = line[0] == 'r' ? CAN_FLAG_RTR : 0;
      for (size_t at = 0; 5 + 2 * at + 1 < line.size() && at < msg.len; at++)
        msg.data[at] = std::stoul(line.substr(5 + 2 * at, 2), nullptr, 16);
      std::error_code error;
      channel.on_read(&msg, -1, error);
    }
    line.clear();
  }
}

static bool all_is_well = true;

static void step(const char* name, bool done) {
  std::printf("%s %s\n", done ? "ok" : "failed", name);
  std::fflush(stdout);
  all_is_well &= done;
}

template <class Condition>
static bool within(std::chrono::milliseconds time, Condition holds) {
  auto end = std::chrono::steady_clock::now() + time;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

// All that an axis does for a master: `channel` 0 has the objects from 6000h on, 1 those from 6800h on.
static void axis(std::shared_ptr<LelyDriverBridge> driver, int control, uint8_t channel) {
  const uint16_t offset = channel * 0x800;
  const std::string number = std::to_string(channel + 1);
  auto motor = std::make_shared<Motor402>(driver, State402::Operation_Enable, 10, channel);
  auto diagnostics = std::make_shared<DiagnosticsCollector>();
  motor->registerDefaultModes();
  motor->set_diagnostic_status_msgs(diagnostics, true);
  std::atomic<bool> ends{false};
  std::thread poll([&] {
    while (!ends) {
      motor->handleRead();
      motor->handleWrite();
      std::this_thread::sleep_for(10ms);
    }
  });
  auto name = [&](const char* text) { return "axis " + number + ": " + text; };
  auto check = [&](const char* text, bool done) { step(name(text).c_str(), done); };
  auto shows = [&](const std::string& text) {
    return within(3s, [&] {
      motor->handleDiag();
      return diagnostics->getMessage() == text;
    });
  };
  auto is_at = [&](double place) { return within(10s, [&] { return std::abs(motor->get_position() - place) <= 10; }); };
  auto runs_at = [&](double speed) { return within(10s, [&] { return std::abs(motor->get_speed() - speed) <= 10; }); };

  driver->universal_set_value<int8_t>(0x6098 + offset, 0, 35);
  check("init with homing where it stands", motor->handleInit());
  check("homed at 0", is_at(0));
  check("profile position mode", motor->enterModeAndWait(MotorBase::Profiled_Position));
  for (double place : {20000.0, -5000.0, 0.0})
    check(("set-point " + std::to_string(int(place))).c_str(), motor->setTarget(place) && is_at(place));
  check("profile velocity mode", motor->enterModeAndWait(MotorBase::Profiled_Velocity));
  for (double speed : {5000.0, -3000.0, 0.0})
    check(("target velocity " + std::to_string(int(speed))).c_str(), motor->setTarget(speed) && runs_at(speed));
  check("cyclic synchronous velocity mode", motor->enterModeAndWait(MotorBase::Cyclic_Synchronous_Velocity));
  for (double speed : {2000.0, 0.0})
    check(("cyclic velocity " + std::to_string(int(speed))).c_str(), motor->setTarget(speed) && runs_at(speed));
  for (auto [text, mode] : {std::pair("cyclic synchronous position mode", MotorBase::Cyclic_Synchronous_Position),
                            std::pair("interpolated position mode", MotorBase::Interpolated_Position)}) {
    check(text, motor->enterModeAndWait(mode));
    double from = motor->get_position();
    for (int at = 1; at <= 50; at++) {
      motor->setTarget(from + at * 20);
      std::this_thread::sleep_for(10ms);
    }
    check(("the last of 50 positions, mode " + std::to_string(mode)).c_str(), is_at(from + 1000));
  }
  check("a mode that 6502h lacks is refused", !motor->enterModeAndWait(MotorBase::Profiled_Torque));

  motor->enterModeAndWait(MotorBase::Profiled_Velocity);
  driver->universal_set_value<int16_t>(0x605A + offset, 0, 6);
  motor->setTarget(5000);
  runs_at(5000);
  check("quick stop", motor->handleHalt() && shows("Quick stop active") && runs_at(0));
  check("recovered from quick stop", motor->handleRecover() && shows("Operation enabled"));

  say(control, "pin sto" + number + " 1\n");
  check("safe torque off is a fault", shows("Fault"));
  say(control, "pin sto" + number + " 0\n");
  std::this_thread::sleep_for(200ms);
  check("recovered from the fault", motor->handleRecover() && shows("Operation enabled"));
  check("disabled", motor->handleDisable() && shows("Switched on"));
  check("enabled", motor->handleEnable() && shows("Operation enabled"));

  // An init of an enabled motor reads an old state and ends at once, so it begins shut down.
  check("shut down", motor->handleShutdown() && shows("Switch on disabled"));
  say(control, "pin limit" + number + "- 0\n");
  driver->universal_set_value<int8_t>(0x6098 + offset, 0, 17);
  std::thread finger([&] {
    within(5s, [&] { return motor->get_speed() < -500; });
    say(control, "pin limit" + number + "- 1\n");
    within(5s, [&] { return motor->get_speed() > 0; });
    say(control, "pin limit" + number + "- 0\n");
  });
  check("init with homing at the negative limit switch", motor->handleInit());
  finger.join();
  check("shut down after homing", motor->handleShutdown() && shows("Switch on disabled"));
  ends = true;
  poll.join();
}

int main(int, char** arguments) {
  int link = connected(arguments[1]), control = connected(arguments[2]);
  lely::io::IoGuard guard;
  lely::io::Context context;
  lely::io::Poll poll(context);
  lely::ev::Loop loop(poll.get_poll());
  auto executor = loop.get_executor();
  lely::io::Timer timer(poll, executor, CLOCK_MONOTONIC);
  lely::io::UserCanChannel channel(context, executor, lely::io::CanBusFlag::NONE, 1000, 0, send_frame, &link);
  say(link, "O\r");
  std::thread receiver(receive_frames, link, std::ref(channel));
  lely::canopen::AsyncMaster master(timer, channel, arguments[3], "", 1);
  auto driver = std::make_shared<LelyDriverBridge>(executor, master, 3, "drive", arguments[4], arguments[5], 1000ms, 5000ms);
  master.Reset();
  // Fibers belong to the thread that made the driver, which therefore runs the loop.
  std::thread tester([&] {
    bool boots = false;
    try {
      boots = driver->wait_for_boot();
    } catch (const std::system_error& error) {
      std::fprintf(stderr, "boot: %s\n", error.what());
    }
    step("boot", boots);
    if (boots) {
      axis(driver, control, 0);
      axis(driver, control, 1);
    }
    std::fflush(nullptr);
    // The threads of the loop and of the link end with the process.
    std::_Exit(all_is_well ? 0 : 1);
  });
  loop.run();
}
