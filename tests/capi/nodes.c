/* Several nodes in one program: each has a handle, and values, time and callbacks of its own. A handle without a node is
 * answered with an error, whatever the other arguments are.
 *
 * The library is of left=firmware/eds/ds301.eds,right=firmware/eds/ds301.eds,text=tests/interop/strings.eds. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "odkit.h"
#include "odkit_objects.h"

#define HEARTBEAT OD_LEFT_PRODUCER_HEARTBEAT_TIME

static int checks;

#define CHECK(condition) check((condition), #condition, __LINE__)

static void check(bool holds, const char *text, int line)
{
    checks++;
    if (!holds) {
        printf("line %d: %s\n", line, text);
        exit(EXIT_FAILURE);
    }
}

/* The library must not get here. */
void odkit_panic(void);
void odkit_panic(void)
{
    abort();
}

/* The handle of the node whose callback runs is in its context. */
static uint32_t handles[2] = {ODKIT_LEFT, ODKIT_RIGHT};
static int written[2];

static void on_written(void *context, uint16_t index, uint8_t sub)
{
    uint32_t own = *(uint32_t *)context;
    uint32_t other = own == ODKIT_LEFT ? ODKIT_RIGHT : ODKIT_LEFT;
    uint32_t value = 0;
    written[own]++;
    CHECK(odkit_get_u32(own, index, sub, &value) == ODKIT_OK);
    /* This node is inside a call, and the other one is not. */
    CHECK(odkit_handle_timeout(own, 0) == ODKIT_BUSY);
    CHECK(odkit_set_u32(other, 0, index, sub, value + 1) == ODKIT_OK);
}

static void power_on(uint32_t node, uint8_t node_id)
{
    odkit_device device;
    odkit_frame frame;
    memset(&device, 0, sizeof device);
    if (node < 2) {
        device.context = &handles[node];
        device.written = on_written;
    }
    CHECK(odkit_power_on(node, 0, node_id, &device) == ODKIT_OK);
    CHECK(odkit_node_id(node) == node_id);
    CHECK(odkit_poll_frame(node, &frame));
    CHECK(frame.id == 0x700u + node_id && frame.len == 1 && frame.data[0] == 0);
}

/* Every function with a handle that no node has. */
static void without_a_node(uint32_t node)
{
    odkit_frame frame;
    odkit_event event;
    uint8_t bytes[8];
    uint32_t u32 = 1;
    int32_t i32 = 2;
    uint64_t u64 = 3;
    int64_t i64 = 4;
    float f32 = 5;
    size_t len = 6;
    memset(&frame, 0, sizeof frame);
    CHECK(odkit_power_on(node, 0, 1, NULL) == ODKIT_NO_NODE);
    CHECK(odkit_handle_frame(node, 0, &frame) == ODKIT_NO_NODE);
    CHECK(odkit_handle_timeout(node, 0) == ODKIT_NO_NODE);
    CHECK(odkit_handle_change(node, 0) == ODKIT_NO_NODE);
    CHECK(odkit_handle_bus(node, 0, ODKIT_BUS_OFF) == ODKIT_NO_NODE);
    CHECK(!odkit_poll_frame(node, &frame));
    CHECK(!odkit_poll_event(node, &event));
    CHECK(odkit_poll_timeout(node, 0) == 1u << 30);
    CHECK(odkit_state(node) == ODKIT_INITIALISATION);
    CHECK(odkit_node_id(node) == 0);
    CHECK(odkit_get(node, HEARTBEAT, bytes, sizeof bytes, &len) == ODKIT_NO_NODE);
    CHECK(odkit_get_u32(node, HEARTBEAT, &u32) == ODKIT_NO_NODE);
    CHECK(odkit_get_i32(node, HEARTBEAT, &i32) == ODKIT_NO_NODE);
    CHECK(odkit_get_u64(node, HEARTBEAT, &u64) == ODKIT_NO_NODE);
    CHECK(odkit_get_i64(node, HEARTBEAT, &i64) == ODKIT_NO_NODE);
    CHECK(odkit_get_f32(node, HEARTBEAT, &f32) == ODKIT_NO_NODE);
    CHECK(u32 == 1 && i32 == 2 && u64 == 3 && i64 == 4 && f32 == 5 && len == 6);
    CHECK(odkit_set(node, 0, HEARTBEAT, bytes, 2) == ODKIT_NO_NODE);
    CHECK(odkit_set_u32(node, 0, HEARTBEAT, 1) == ODKIT_NO_NODE);
    CHECK(odkit_set_i32(node, 0, HEARTBEAT, 1) == ODKIT_NO_NODE);
    CHECK(odkit_set_u64(node, 0, HEARTBEAT, 1) == ODKIT_NO_NODE);
    CHECK(odkit_set_i64(node, 0, HEARTBEAT, 1) == ODKIT_NO_NODE);
    CHECK(odkit_set_f32(node, 0, HEARTBEAT, 1) == ODKIT_NO_NODE);
    CHECK(odkit_raise(node, 0, 0x4200, 1, NULL) == ODKIT_NO_NODE);
    CHECK(odkit_clear(node, 0, 0x4200, 1, NULL) == ODKIT_NO_NODE);
    CHECK(odkit_power_off(node) == ODKIT_NO_NODE);
}

/* A master writes 1017h of the left node; its callback writes that of the right node. */
static void values_of_their_own(void)
{
    odkit_frame frame;
    uint32_t value = 0;
    memset(&frame, 0, sizeof frame);
    frame.id = 0x601;
    frame.len = 8;
    memcpy(frame.data, "\x2B\x17\x10\x00\xF4\x01\x00\x00", 8);
    /* It is for node 1, so the right node ignores it. */
    CHECK(odkit_handle_frame(ODKIT_RIGHT, 1000, &frame) == ODKIT_OK);
    CHECK(!odkit_poll_frame(ODKIT_RIGHT, &frame));
    CHECK(odkit_handle_frame(ODKIT_LEFT, 1000, &frame) == ODKIT_OK);
    CHECK(odkit_poll_frame(ODKIT_LEFT, &frame) && frame.id == 0x581 && frame.data[0] == 0x60);
    CHECK(written[ODKIT_LEFT] == 1 && written[ODKIT_RIGHT] == 0);
    CHECK(odkit_get_u32(ODKIT_LEFT, HEARTBEAT, &value) == ODKIT_OK && value == 500);
    CHECK(odkit_get_u32(ODKIT_RIGHT, HEARTBEAT, &value) == ODKIT_OK && value == 501);
    CHECK(odkit_get_u32(ODKIT_TEXT, OD_TEXT_PRODUCER_HEARTBEAT_TIME, &value) == ODKIT_OK);
    CHECK(value != 500 && value != 501);
    /* 1029h is not an object of the third node. */
    CHECK(odkit_get_u32(ODKIT_TEXT, 0x1029, 1, &value) == 0x06020000);
}

/* Time is that of each node: the left one sends its heartbeat, the right one does not know the time yet. */
static void time_of_their_own(void)
{
    odkit_frame frame;
    CHECK(odkit_poll_timeout(ODKIT_LEFT, 501000) == 0);
    CHECK(odkit_handle_timeout(ODKIT_LEFT, 501000) == ODKIT_OK);
    CHECK(odkit_poll_frame(ODKIT_LEFT, &frame) && frame.id == 0x701);
    CHECK(odkit_poll_timeout(ODKIT_RIGHT, 2000) > 400000);
    CHECK(odkit_handle_timeout(ODKIT_RIGHT, 2000) == ODKIT_OK);
    CHECK(!odkit_poll_frame(ODKIT_RIGHT, &frame));
}

int main(void)
{
    static const uint32_t missing[] = {3, 4, 255, 256, 0x10000, 0xFFFFFFFFu};
    size_t at;
    CHECK(ODKIT_LEFT == 0 && ODKIT_RIGHT == 1 && ODKIT_TEXT == 2);
    CHECK(odkit_handle_timeout(ODKIT_RIGHT, 0) == ODKIT_STATE);
    power_on(ODKIT_LEFT, 1);
    CHECK(odkit_handle_timeout(ODKIT_RIGHT, 0) == ODKIT_STATE);
    power_on(ODKIT_RIGHT, 2);
    power_on(ODKIT_TEXT, 3);
    for (at = 0; at < sizeof missing / sizeof *missing; at++) {
        without_a_node(missing[at]);
    }
    values_of_their_own();
    time_of_their_own();
    CHECK(odkit_power_off(ODKIT_LEFT) == ODKIT_OK);
    CHECK(odkit_state(ODKIT_LEFT) == ODKIT_INITIALISATION);
    CHECK(odkit_state(ODKIT_RIGHT) == ODKIT_PRE_OPERATIONAL);
    printf("%d checks\n", checks);
    return EXIT_SUCCESS;
}
