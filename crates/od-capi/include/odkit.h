/* A CANopen node: odkit for C.
 *
 * Made by cbindgen; see crates/od-capi/tests/header.rs.
 *
 * Functions that return uint32_t return ODKIT_OK, an error of the call (ODKIT_NULL and so on), or an
 * SDO abort code of CiA 301 (0x05030000 and above).
 *
 * Each node of the program has a handle, the first argument of all functions: a macro of
 * odkit_objects.h, ODKIT_NODE of a library with one node.
 *
 * One thread at a time may call for a node; an interrupt or a thread that calls while another call is
 * not over gets ODKIT_BUSY, as long as that call is not inside a callback. Pointers are used during
 * the call only, but for the callbacks and the context of odkit_power_on.
 *
 * The library uses static memory only. If it finds an error in itself, it calls
 * `void odkit_panic(void)`, which the firmware defines and which must not return; a linker that drops
 * unused functions asks for it only if the library can get there.
 */

#ifndef ODKIT_H
#define ODKIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* An address as one number, for `switch (ODKIT_KEY(index, sub))` and `case ODKIT_KEY(OD_TEMPERATURE):`. Not in C89 and
 * C++98, which have no macros with a variable number of arguments; ODKIT_KEY_OF takes index and sub-index there. */
#if (defined(__STDC_VERSION__) && __STDC_VERSION__ >= 199901L) || (defined(__cplusplus) && __cplusplus >= 201103L)
#define ODKIT_KEY(...) ODKIT_KEY_OF(__VA_ARGS__)
#endif
#define ODKIT_KEY_OF(index, sub) ((uint32_t)(index) << 8 | (uint32_t)(sub))

/*
 Success.
 */
#define ODKIT_OK 0

/*
 A pointer is null.
 */
#define ODKIT_NULL 1

/*
 Another call has not returned yet: this call came from an interrupt or a thread, or from a
 callback in which it is not allowed.
 */
#define ODKIT_BUSY 2

/*
 Not possible in this state: the node has no power, or has power already.
 */
#define ODKIT_STATE 3

/*
 An argument has an invalid value.
 */
#define ODKIT_ARGUMENT 4

/*
 The buffer is too short for the value.
 */
#define ODKIT_SIZE 5

/*
 The object has another data type.
 */
#define ODKIT_TYPE 6

/*
 The library has no node with this handle.
 */
#define ODKIT_NO_NODE 7

/*
 SDO abort code 06060000h: a hardware error.
 */
#define ODKIT_ABORT_HARDWARE 101056512

/*
 SDO abort code 06090030h: the value is not allowed.
 */
#define ODKIT_ABORT_VALUE 101253168

/*
 SDO abort code 06090031h: the value is above the upper limit.
 */
#define ODKIT_ABORT_TOO_HIGH 101253169

/*
 SDO abort code 06090032h: the value is below the lower limit.
 */
#define ODKIT_ABORT_TOO_LOW 101253170

/*
 SDO abort code 08000000h: a general error.
 */
#define ODKIT_ABORT_GENERAL 134217728

/*
 SDO abort code 08000021h: the device does not allow it now (local control).
 */
#define ODKIT_ABORT_LOCAL 134217761

/*
 SDO abort code 08000022h: not in the present state of the device.
 */
#define ODKIT_ABORT_STATE 134217762

/*
 Flag of a frame: its CAN-ID has 29 bits.
 */
#define ODKIT_EXTENDED 1

/*
 Flag of a frame: it is a remote frame.
 */
#define ODKIT_REMOTE 2

/*
 NMT state: Initialisation, or no power.
 */
#define ODKIT_INITIALISATION 0

/*
 NMT state: Stopped.
 */
#define ODKIT_STOPPED 4

/*
 NMT state: Operational.
 */
#define ODKIT_OPERATIONAL 5

/*
 NMT state: Pre-operational.
 */
#define ODKIT_PRE_OPERATIONAL 127

/*
 Node ID of a device that waits for LSS to give it one.
 */
#define ODKIT_UNCONFIGURED 255

/*
 CAN controller: error active again, no further frames are lost; after bus-off: it can restart.
 */
#define ODKIT_BUS_ACTIVE 0

/*
 CAN controller: an error counter passed the warning limit (96).
 */
#define ODKIT_BUS_WARNING 1

/*
 CAN controller: error passive.
 */
#define ODKIT_BUS_PASSIVE 2

/*
 CAN controller: bus-off.
 */
#define ODKIT_BUS_OFF 3

/*
 CAN controller: a received frame was lost.
 */
#define ODKIT_BUS_OVERRUN 4

/*
 Reset at power-on: everything in RAM is lost.
 */
#define ODKIT_RESET_POWER_ON 0

/*
 NMT reset node: all values are loaded again.
 */
#define ODKIT_RESET_NODE 1

/*
 NMT reset communication: 1000h to 1FFFh are loaded again.
 */
#define ODKIT_RESET_COMMUNICATION 2

/*
 1011h restored the default values in RAM.
 */
#define ODKIT_RESET_DEFAULTS 3

/*
 A deadline that never comes, as result of the callback `tick`.
 */
#define ODKIT_NEVER 4294967295

/*
 Event: the NMT state changed. `value`: the state.
 */
#define ODKIT_EVENT_STATE 1

/*
 Event: a reset. `value`: ODKIT_RESET_POWER_ON to ODKIT_RESET_DEFAULTS; `sub`: the node ID.
 */
#define ODKIT_EVENT_RESET 2

/*
 Event: a master wrote the object `index`, `sub`.
 */
#define ODKIT_EVENT_WRITTEN 3

/*
 Event: 1010h saved values. `sub`: its sub-index.
 */
#define ODKIT_EVENT_SAVED 4

/*
 Event: 1011h restored default values. `sub`: its sub-index.
 */
#define ODKIT_EVENT_RESTORED 5

/*
 Event: LSS activated a bit rate. `value`: kbit/s.
 */
#define ODKIT_EVENT_BIT_RATE 6

/*
 Event: the memory is not as the last save left it. `value`: ODKIT_STORAGE_PARTIAL and so on.
 */
#define ODKIT_EVENT_STORAGE 7

/*
 Event: a save failed. The values saved before it remain.
 */
#define ODKIT_EVENT_NOT_SAVED 8

/*
 Event: power loss or a reset interrupted a save. `value`: 1 if the default values were loaded.
 */
#define ODKIT_EVENT_SAVE_CUT 9

/*
 Event: the node is bus-off. `value`: 1 if it restarts when the bus allows it.
 */
#define ODKIT_EVENT_BUS_OFF 10

/*
 Event: the node returned from bus-off.
 */
#define ODKIT_EVENT_BUS_ON 11

/*
 Event: an error began. `value`: its EMCY code.
 */
#define ODKIT_EVENT_ERROR 12

/*
 Event: an error ended. `value`: its EMCY code.
 */
#define ODKIT_EVENT_ERROR_CLEARED 13

/*
 Event of a later version of odkit.
 */
#define ODKIT_EVENT_OTHER 255

/*
 Memory: some saved values fit no object of this dictionary.
 */
#define ODKIT_STORAGE_PARTIAL 1

/*
 Memory: the last set was loaded, although bits outside it changed.
 */
#define ODKIT_STORAGE_FLAWED 2

/*
 Memory: the last set is damaged; the one before it was loaded.
 */
#define ODKIT_STORAGE_OLDER 3

/*
 Memory: its content belongs to another device; default values.
 */
#define ODKIT_STORAGE_FOREIGN 4

/*
 Memory: its content cannot be read; default values.
 */
#define ODKIT_STORAGE_DAMAGED 5

/*
 Handle of a node: a macro of odkit_objects.h; ODKIT_NODE in a library with one node. Without a
 node with this handle a function does nothing, and returns ODKIT_NO_NODE or false.
 */
typedef uint32_t odkit_node;

/*
 Non-volatile memory for the values that 1010h saves.

 For EEPROM or FRAM `page` and `word` are 0. For NOR flash `page` is the number of bytes that
 `erase` erases, and `word` the number of bytes that are written at once, each once after an
 erasure.

 The callbacks return 0 for success. They may not call functions of odkit.
 */
typedef struct odkit_storage {
  /*
   Number of bytes of the memory, at most 2147483647 (2^31 - 1) and a multiple of `page`; 0: none, and a save fails.
   */
  uint32_t capacity;
  /*
   Number of bytes of a page of flash; 0 for an EEPROM.
   */
  uint32_t page;
  /*
   Bytes that are written at once: a power of two up to 32 that divides `page`; 0 means 1.
   */
  uint32_t word;
  /*
   Fills `to` with `len` bytes from `offset` on.
   */
  int32_t (*read)(void *context, uint32_t offset, uint8_t *to, uint32_t len);
  /*
   Writes `len` bytes from `offset` on.
   */
  int32_t (*write)(void *context, uint32_t offset, const uint8_t *from, uint32_t len);
  /*
   Sets the page at `offset` to FFh; needed if `page` is not 0.
   */
  int32_t (*erase)(void *context, uint32_t offset);
  /*
   Makes sure that all written bytes survive a power failure; may be null.
   */
  int32_t (*flush)(void *context);
} odkit_storage;

/*
 Behaviour of the device: callbacks, each of which may be null. Set unused fields to 0.

 A callback runs inside the call of odkit that caused it. It may call odkit_get, odkit_set (which
 does not check limits there), odkit_raise and odkit_clear; other functions return ODKIT_BUSY.
 */
typedef struct odkit_device {
  /*
   First argument of each callback.
   */
  void *context;
  /*
   Called when values were loaded; `reset` is ODKIT_RESET_POWER_ON and so on. Set values here
   that the firmware knows better than the EDS, such as the serial number.
   */
  void (*reset)(void *context, uint8_t reset);
  /*
   Returns the node ID of the switches at a reset, 1 to 127; 0: the node keeps its own.
   */
  uint8_t (*node_id)(void *context);
  /*
   Called before an SDO or a PDO reads this value (2000h and above): bring it up to date with
   odkit_set. Returns 0, or the abort code of the SDO.
   */
  uint32_t (*refresh)(void *context, uint16_t index, uint8_t sub);
  /*
   Called when a master writes this value, which fits the object and its limits. Returns 0, or
   the abort code of the SDO; the value then stays unchanged.
   */
  uint32_t (*validate)(void *context, uint16_t index, uint8_t sub, const uint8_t *value, size_t len);
  /*
   Called when a value was written; odkit_get returns it.
   */
  void (*written)(void *context, uint16_t index, uint8_t sub);
  /*
   Acts on time or on odkit_handle_change. Returns the microseconds until its next call;
   ODKIT_NEVER: only after a change.
   */
  uint32_t (*tick)(void *context);
  /*
   Memory for saved values.
   */
  struct odkit_storage storage;
} odkit_device;

/*
 Classical CAN frame.
 */
typedef struct odkit_frame {
  /*
   Identifier: 11 bits, or 29 with ODKIT_EXTENDED.
   */
  uint32_t id;
  /*
   ODKIT_EXTENDED, ODKIT_REMOTE, both or 0.
   */
  uint8_t flags;
  /*
   Data length code, 0 to 8.
   */
  uint8_t len;
  /*
   Data; the bytes after `len` are 0 in a frame to send.
   */
  uint8_t data[8];
} odkit_frame;

/*
 Event of the node.
 */
typedef struct odkit_event {
  /*
   ODKIT_EVENT_STATE and so on.
   */
  uint8_t kind;
  /*
   Sub-index, if the kind has one.
   */
  uint8_t sub;
  /*
   Index, if the kind has one.
   */
  uint16_t index;
  /*
   Number that the kind describes.
   */
  uint32_t value;
} odkit_event;

#ifdef __cplusplus
extern "C" {
#endif /* __cplusplus */

/*
 Switches the power of a node on: it loads the saved values or their defaults, and boots
 up.

 `now_us` is a counter of microseconds that may start anywhere and wraps at 2^32.
 `node_id` is 1 to 127; or ODKIT_UNCONFIGURED for a device that waits for LSS. A saved node ID
 or the callback `node_id` replaces it. `device` may be null; it is copied.
 */
uint32_t odkit_power_on(odkit_node node,
                        uint32_t now_us,
                        uint8_t node_id,
                        const struct odkit_device *device);

/*
 Switches the power off: the node is silent until odkit_power_on.
 */
uint32_t odkit_power_off(odkit_node node);

/*
 Handles a frame that was received.
 */
uint32_t odkit_handle_frame(odkit_node node, uint32_t now_us, const struct odkit_frame *frame);

/*
 Carries out what is due at `now_us`. Call it after the time of odkit_poll_timeout; an
 earlier or later call does no harm.
 */
uint32_t odkit_handle_timeout(odkit_node node, uint32_t now_us);

/*
 Reports a change outside the bus: the node calls `tick`.
 */
uint32_t odkit_handle_change(odkit_node node, uint32_t now_us);

/*
 Reports the state of the CAN controller, ODKIT_BUS_ACTIVE to ODKIT_BUS_OVERRUN.
 */
uint32_t odkit_handle_bus(odkit_node node, uint32_t now_us, uint8_t state);

/*
 Fills `to` with the next frame to send; returns false if no frame waits. Call it after
 every other function, and when the CAN controller has room again, until it returns
 false.
 */
bool odkit_poll_frame(odkit_node node, struct odkit_frame *to);

/*
 Returns the microseconds until the next call of odkit_handle_timeout, at most 2^30 (18
 minutes), so that no wrap of the counter is missed; 2^30 also without such a node.
 */
uint32_t odkit_poll_timeout(odkit_node node, uint32_t now_us);

/*
 Fills `to` with the oldest event; returns false if no event waits. The node keeps 16
 events; a firmware without use for events does not have to call this.
 */
bool odkit_poll_event(odkit_node node, struct odkit_event *to);

/*
 Returns the NMT state, ODKIT_INITIALISATION to ODKIT_PRE_OPERATIONAL;
 ODKIT_INITIALISATION also without such a node.
 */
uint8_t odkit_state(odkit_node node);

/*
 Returns the node ID, or ODKIT_UNCONFIGURED; 0 without such a node.
 */
uint8_t odkit_node_id(odkit_node node);

/*
 Copies a value in the form of an SDO (numbers little-endian), at most `size` bytes.
 `len`, if not null, becomes the length of the value, even if it is longer than `size`.
 */
uint32_t odkit_get(odkit_node node,
                   uint16_t index,
                   uint8_t sub,
                   void *to,
                   size_t size,
                   size_t *len);

/*
 Sets a value, also of a read-only object; limits and rules are those for a master.
 Event-driven TPDOs with it are sent. In a callback limits are not checked, and `now_us` is
 ignored.
 */
uint32_t odkit_set(odkit_node node,
                   uint32_t now_us,
                   uint16_t index,
                   uint8_t sub,
                   const void *from,
                   size_t len);

/*
 Reads an UNSIGNED8 to UNSIGNED32 or a BOOLEAN.
 */
uint32_t odkit_get_u32(odkit_node node, uint16_t index, uint8_t sub, uint32_t *to);

/*
 Reads an INTEGER8 to INTEGER32.
 */
uint32_t odkit_get_i32(odkit_node node, uint16_t index, uint8_t sub, int32_t *to);

/*
 Sets an UNSIGNED8 to UNSIGNED32 or a BOOLEAN, as odkit_set does. ODKIT_ARGUMENT: its type
 cannot hold the value.
 */
uint32_t odkit_set_u32(odkit_node node,
                       uint32_t now_us,
                       uint16_t index,
                       uint8_t sub,
                       uint32_t value);

/*
 Sets an INTEGER8 to INTEGER32, as odkit_set does. ODKIT_ARGUMENT: its type cannot hold the
 value.
 */
uint32_t odkit_set_i32(odkit_node node,
                       uint32_t now_us,
                       uint16_t index,
                       uint8_t sub,
                       int32_t value);

/*
 Reads an UNSIGNED8 to UNSIGNED64 or a BOOLEAN.
 */
uint32_t odkit_get_u64(odkit_node node, uint16_t index, uint8_t sub, uint64_t *to);

/*
 Sets an UNSIGNED8 to UNSIGNED64 or a BOOLEAN, as odkit_set does. ODKIT_ARGUMENT: its type
 cannot hold the value.
 */
uint32_t odkit_set_u64(odkit_node node,
                       uint32_t now_us,
                       uint16_t index,
                       uint8_t sub,
                       uint64_t value);

/*
 Reads an INTEGER8 to INTEGER64.
 */
uint32_t odkit_get_i64(odkit_node node, uint16_t index, uint8_t sub, int64_t *to);

/*
 Sets an INTEGER8 to INTEGER64, as odkit_set does. ODKIT_ARGUMENT: its type cannot hold the
 value.
 */
uint32_t odkit_set_i64(odkit_node node,
                       uint32_t now_us,
                       uint16_t index,
                       uint8_t sub,
                       int64_t value);

/*
 Reads a REAL32.
 */
uint32_t odkit_get_f32(odkit_node node, uint16_t index, uint8_t sub, float *to);

/*
 Sets a REAL32, as odkit_set does.
 */
uint32_t odkit_set_f32(odkit_node node, uint32_t now_us, uint16_t index, uint8_t sub, float value);

/*
 Reports an error: the node sends an EMCY message, unless the error is active already.
 `register` has the bits of 1001h that it sets, `info` five manufacturer-specific bytes;
 null means zeros.
 */
uint32_t odkit_raise(odkit_node node,
                     uint32_t now_us,
                     uint16_t code,
                     uint8_t register_,
                     const uint8_t *info);

/*
 Reports the end of the error with this code and these bits of 1001h.
 */
uint32_t odkit_clear(odkit_node node,
                     uint32_t now_us,
                     uint16_t code,
                     uint8_t register_,
                     const uint8_t *info);

#ifdef __cplusplus
}  /* extern "C" */
#endif  /* __cplusplus */

#endif  /* ODKIT_H */
