/* What the functions answer to right and wrong calls, in C99; `calls.cpp` is the same in C++.
 *
 * The device is firmware/eds/ds301.eds+tests/capi/all.overlay. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "odkit.h"
#include "odkit_objects.h"

#define DEVICE_NAME OD_MANUFACTURER_DEVICE_NAME
#define HEARTBEAT OD_PRODUCER_HEARTBEAT_TIME

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

static uint8_t memory[4096];
static int saves, resets, writes, ticks, refreshes;
static uint32_t refusal;

static int32_t memory_read(void *context, uint32_t offset, uint8_t *to, uint32_t len)
{
    CHECK(context == memory && offset + len <= sizeof memory);
    memcpy(to, memory + offset, len);
    /* The node is in the middle of something. */
    CHECK(odkit_handle_timeout(ODKIT_NODE, 0) == ODKIT_BUSY);
    CHECK(odkit_set_u32(ODKIT_NODE, 0, HEARTBEAT, 1) == ODKIT_BUSY);
    return 0;
}

static int32_t memory_write(void *context, uint32_t offset, const uint8_t *from, uint32_t len)
{
    CHECK(context == memory && offset + len <= sizeof memory);
    memcpy(memory + offset, from, len);
    saves++;
    return 0;
}

static int32_t memory_erase(void *context, uint32_t offset)
{
    (void)context;
    (void)offset;
    return 1;
}

static void on_reset(void *context, uint8_t reset)
{
    CHECK(context == memory);
    CHECK(reset == ODKIT_RESET_POWER_ON || reset == ODKIT_RESET_NODE);
    resets++;
    CHECK(odkit_set_u32(ODKIT_NODE, 0, OD_IDENTITY_OBJECT_SERIAL_NUMBER, 4712) == ODKIT_OK);
    CHECK(odkit_power_off(ODKIT_NODE) == ODKIT_BUSY);
    CHECK(odkit_state(ODKIT_NODE) == ODKIT_INITIALISATION);
}

static uint32_t on_refresh(void *context, uint16_t index, uint8_t sub)
{
    (void)context;
    refreshes++;
    CHECK(index >= 0x2000);
    return index == 0x6000 ? odkit_set_u32(ODKIT_NODE, 0, index, sub, 42) : ODKIT_OK;
}

static uint32_t on_validate(void *context, uint16_t index, uint8_t sub, const uint8_t *value,
                            size_t len)
{
    (void)context;
    CHECK(value != NULL && len > 0);
    (void)sub;
    return index == 0x1017 ? refusal : ODKIT_OK;
}

static void on_written(void *context, uint16_t index, uint8_t sub)
{
    uint32_t value = 0;
    (void)context;
    writes++;
    if (index == 0x1017) {
        CHECK(odkit_get_u32(ODKIT_NODE, index, sub, &value) == ODKIT_OK);
        CHECK(value == 500);
    }
}

static uint32_t on_tick(void *context)
{
    (void)context;
    ticks++;
    return 250000;
}

/* The next frame is this one. */
static void expect(uint32_t id, const char *data, size_t len)
{
    odkit_frame frame;
    CHECK(odkit_poll_frame(ODKIT_NODE, &frame));
    CHECK(frame.id == id && frame.flags == 0 && frame.len == len);
    CHECK(memcmp(frame.data, data, len) == 0);
}

static void send(uint32_t now, uint32_t id, const char *data, uint8_t len)
{
    odkit_frame frame;
    memset(&frame, 0, sizeof frame);
    frame.id = id;
    frame.len = len;
    memcpy(frame.data, data, len);
    CHECK(odkit_handle_frame(ODKIT_NODE, now, &frame) == ODKIT_OK);
}

/* An event of this kind, after any others. */
static odkit_event event(uint8_t kind)
{
    odkit_event found;
    do {
        CHECK(odkit_poll_event(ODKIT_NODE, &found));
    } while (found.kind != kind);
    return found;
}

static odkit_device device(void)
{
    odkit_device made;
    memset(&made, 0, sizeof made);
    made.context = memory;
    made.reset = on_reset;
    made.refresh = on_refresh;
    made.validate = on_validate;
    made.written = on_written;
    made.tick = on_tick;
    made.storage.capacity = sizeof memory;
    made.storage.read = memory_read;
    made.storage.write = memory_write;
    return made;
}

static void without_power(void)
{
    odkit_frame frame;
    uint32_t number;
    memset(&frame, 0, sizeof frame);
    CHECK(odkit_handle_frame(ODKIT_NODE, 0, &frame) == ODKIT_STATE);
    CHECK(odkit_handle_timeout(ODKIT_NODE, 0) == ODKIT_STATE);
    CHECK(odkit_handle_change(ODKIT_NODE, 0) == ODKIT_STATE);
    CHECK(odkit_handle_bus(ODKIT_NODE, 0, ODKIT_BUS_OFF) == ODKIT_STATE);
    CHECK(odkit_get_u32(ODKIT_NODE, HEARTBEAT, &number) == ODKIT_STATE);
    CHECK(odkit_set_u32(ODKIT_NODE, 0, HEARTBEAT, 1) == ODKIT_STATE);
    CHECK(odkit_raise(ODKIT_NODE, 0, 0x4200, 1, NULL) == ODKIT_STATE);
    CHECK(odkit_clear(ODKIT_NODE, 0, 0x4200, 1, NULL) == ODKIT_STATE);
    CHECK(!odkit_poll_frame(ODKIT_NODE, &frame));
    CHECK(odkit_state(ODKIT_NODE) == ODKIT_INITIALISATION);
    CHECK(odkit_poll_timeout(ODKIT_NODE, 0) > 0);
}

static void wrong_devices(void)
{
    odkit_device bad = device();
    CHECK(odkit_power_on(ODKIT_NODE, 0, 0, NULL) == ODKIT_ARGUMENT);
    CHECK(odkit_power_on(ODKIT_NODE, 0, 128, NULL) == ODKIT_ARGUMENT);
    bad.storage.read = NULL;
    CHECK(odkit_power_on(ODKIT_NODE, 0, 1, &bad) == ODKIT_ARGUMENT);
    bad = device();
    bad.storage.page = 1024;
    CHECK(odkit_power_on(ODKIT_NODE, 0, 1, &bad) == ODKIT_ARGUMENT);
    bad = device();
    bad.storage.word = 3;
    CHECK(odkit_power_on(ODKIT_NODE, 0, 1, &bad) == ODKIT_ARGUMENT);
    bad.storage.word = 64;
    CHECK(odkit_power_on(ODKIT_NODE, 0, 1, &bad) == ODKIT_ARGUMENT);
    /* A word that is longer than a page. */
    bad.storage.page = 8;
    bad.storage.word = 16;
    bad.storage.erase = memory_erase;
    CHECK(odkit_power_on(ODKIT_NODE, 0, 1, &bad) == ODKIT_ARGUMENT);
    CHECK(resets == 0);
}

static void values(void)
{
    char text[80];
    uint8_t bytes[4] = {1, 2, 3, 4};
    size_t len = 0;
    uint32_t number = 0;
    int32_t signed_number = 0;
    float ratio = 0;
    int64_t distance = 0;
    uint64_t large = 0;
    /* The whole value, only its length, and too little room. */
    CHECK(odkit_get(ODKIT_NODE, DEVICE_NAME, text, sizeof text, &len) == ODKIT_OK && len > 0);
    CHECK(odkit_get(ODKIT_NODE, DEVICE_NAME, NULL, 0, &len) == ODKIT_SIZE && len > 0);
    CHECK(odkit_get(ODKIT_NODE, DEVICE_NAME, text, len - 1, NULL) == ODKIT_SIZE);
    CHECK(odkit_get(ODKIT_NODE, DEVICE_NAME, text, len, NULL) == ODKIT_OK);
    CHECK(odkit_get(ODKIT_NODE, DEVICE_NAME, NULL, 1, NULL) == ODKIT_NULL);
    CHECK(odkit_get(ODKIT_NODE, 0x4000, 0, text, sizeof text, &len) == 0x06020000);
    CHECK(odkit_get(ODKIT_NODE, 0x1018, 9, text, sizeof text, &len) == 0x06090011);
    /* Types. */
    CHECK(odkit_get_u32(ODKIT_NODE, HEARTBEAT, NULL) == ODKIT_NULL);
    CHECK(odkit_get_i32(ODKIT_NODE, HEARTBEAT, &signed_number) == ODKIT_TYPE);
    CHECK(odkit_get_u32(ODKIT_NODE, DEVICE_NAME, &number) == ODKIT_TYPE);
    CHECK(odkit_set_u32(ODKIT_NODE, 0, HEARTBEAT, 0x10000) == ODKIT_ARGUMENT);
    CHECK(odkit_set_i32(ODKIT_NODE, 0, HEARTBEAT, 1) == ODKIT_TYPE);
    CHECK(odkit_get_i32(ODKIT_NODE, OD_TEMPERATURE, &signed_number) == ODKIT_OK);
    CHECK(signed_number == -5);
    CHECK(odkit_get_u32(ODKIT_NODE, OD_TEMPERATURE, &number) == ODKIT_TYPE);
    CHECK(odkit_set_i32(ODKIT_NODE, 0, OD_TEMPERATURE, -40) == ODKIT_OK);
    CHECK(odkit_set_i32(ODKIT_NODE, 0, OD_TEMPERATURE, -41) == ODKIT_ABORT_TOO_LOW);
    CHECK(odkit_set_i32(ODKIT_NODE, 0, OD_TEMPERATURE, 126) == ODKIT_ABORT_TOO_HIGH);
    CHECK(odkit_set_i32(ODKIT_NODE, 0, OD_TEMPERATURE, 32768) == ODKIT_ARGUMENT);
    CHECK(odkit_get_i32(ODKIT_NODE, OD_TEMPERATURE, &signed_number) == ODKIT_OK);
    CHECK(signed_number == -40);
    CHECK(odkit_get_f32(ODKIT_NODE, OD_RATIO, &ratio) == ODKIT_OK && ratio == 0.5f);
    CHECK(odkit_set_f32(ODKIT_NODE, 0, OD_RATIO, -1.25f) == ODKIT_OK);
    CHECK(odkit_get_f32(ODKIT_NODE, OD_RATIO, &ratio) == ODKIT_OK && ratio == -1.25f);
    CHECK(odkit_set_f32(ODKIT_NODE, 0, OD_RATIO, 2.5f) == ODKIT_ABORT_TOO_HIGH);
    CHECK(odkit_set_f32(ODKIT_NODE, 0, OD_RATIO, NAN) == ODKIT_ABORT_VALUE);
    CHECK(odkit_get_f32(ODKIT_NODE, HEARTBEAT, &ratio) == ODKIT_TYPE);
    CHECK(odkit_set_f32(ODKIT_NODE, 0, OD_DISTANCE, 1.0f) == ODKIT_TYPE);
    CHECK(odkit_get_f32(ODKIT_NODE, OD_RATIO, NULL) == ODKIT_NULL);
    CHECK(odkit_get_i64(ODKIT_NODE, OD_DISTANCE, &distance) == ODKIT_OK);
    CHECK(distance == -5000000000LL);
    CHECK(odkit_set_i64(ODKIT_NODE, 0, OD_DISTANCE, 7000000000LL) == ODKIT_OK);
    CHECK(odkit_get_i64(ODKIT_NODE, OD_DISTANCE, &distance) == ODKIT_OK);
    CHECK(distance == 7000000000LL);
    CHECK(odkit_get_i32(ODKIT_NODE, OD_DISTANCE, &signed_number) == ODKIT_TYPE);
    CHECK(odkit_get_u64(ODKIT_NODE, OD_DISTANCE, &large) == ODKIT_TYPE);
    CHECK(odkit_get_i64(ODKIT_NODE, OD_TEMPERATURE, &distance) == ODKIT_OK && distance == -40);
    CHECK(odkit_set_i64(ODKIT_NODE, 0, OD_TEMPERATURE, 7000000000LL) == ODKIT_ARGUMENT);
    CHECK(odkit_set_u64(ODKIT_NODE, 0, HEARTBEAT, 0x100000000ULL) == ODKIT_ARGUMENT);
    CHECK(odkit_get_u64(ODKIT_NODE, OD_IDENTITY_OBJECT_SERIAL_NUMBER, &large) == ODKIT_OK);
    CHECK(large == 4712);
    /* An address in a switch. */
    switch (ODKIT_KEY(0x2001, 0)) {
    case ODKIT_KEY(OD_RATIO):
        CHECK(false);
        break;
    case ODKIT_KEY(OD_TEMPERATURE):
        CHECK(true);
        break;
    default:
        CHECK(false);
    }
    CHECK(odkit_set(ODKIT_NODE, 0, HEARTBEAT, bytes, 1) == 0x06070013);
    CHECK(odkit_set(ODKIT_NODE, 0, HEARTBEAT, bytes, 4) == 0x06070012);
    CHECK(odkit_set(ODKIT_NODE, 0, HEARTBEAT, NULL, 2) == ODKIT_NULL);
    CHECK(odkit_set(ODKIT_NODE, 0, HEARTBEAT, bytes, (size_t)-1) == ODKIT_ARGUMENT);
    CHECK(odkit_get_u32(ODKIT_NODE, OD_IDENTITY_OBJECT_SERIAL_NUMBER, &number) == ODKIT_OK);
    CHECK(number == 4712);
    /* Pointers of any alignment. */
    CHECK(odkit_get_u32(ODKIT_NODE, HEARTBEAT, (uint32_t *)(void *)(text + 1)) == ODKIT_OK);
}

static void frames(void)
{
    odkit_frame frame;
    odkit_event gone;
    memset(&frame, 0, sizeof frame);
    CHECK(odkit_handle_frame(ODKIT_NODE, 0, NULL) == ODKIT_NULL);
    CHECK(!odkit_poll_frame(ODKIT_NODE, NULL));
    CHECK(!odkit_poll_event(ODKIT_NODE, NULL));
    frame.id = 0x800;
    CHECK(odkit_handle_frame(ODKIT_NODE, 0, &frame) == ODKIT_ARGUMENT);
    frame.flags = ODKIT_EXTENDED;
    CHECK(odkit_handle_frame(ODKIT_NODE, 0, &frame) == ODKIT_OK);
    frame.id = 0x20000000;
    CHECK(odkit_handle_frame(ODKIT_NODE, 0, &frame) == ODKIT_ARGUMENT);
    frame.id = 0;
    frame.len = 9;
    CHECK(odkit_handle_frame(ODKIT_NODE, 0, &frame) == ODKIT_ARGUMENT);
    frame.len = 0;
    frame.flags = 4;
    CHECK(odkit_handle_frame(ODKIT_NODE, 0, &frame) == ODKIT_ARGUMENT);
    CHECK(odkit_handle_bus(ODKIT_NODE, 0, 5) == ODKIT_ARGUMENT);
    CHECK(!odkit_poll_frame(ODKIT_NODE, &frame));

    /* A master writes 1017h: refused, then accepted, and the heartbeat starts. */
    refusal = ODKIT_ABORT_LOCAL;
    send(1000, 0x607, "\x2B\x17\x10\x00\xF4\x01\x00\x00", 8);
    expect(0x587, "\x80\x17\x10\x00\x21\x00\x00\x08", 8);
    refusal = 12345; /* no abort code of CiA 301 */
    send(1000, 0x607, "\x2B\x17\x10\x00\xF4\x01\x00\x00", 8);
    expect(0x587, "\x80\x17\x10\x00\x00\x00\x00\x08", 8);
    refusal = 0;
    CHECK(writes == 0);
    while (odkit_poll_event(ODKIT_NODE, &gone)) {
    }
    send(1000, 0x607, "\x2B\x17\x10\x00\xF4\x01\x00\x00", 8);
    expect(0x587, "\x60\x17\x10\x00\x00\x00\x00\x00", 8);
    CHECK(writes == 1);
    gone = event(ODKIT_EVENT_WRITTEN);
    CHECK(gone.index == 0x1017 && gone.sub == 0);
    CHECK(odkit_poll_timeout(ODKIT_NODE, 1000) <= 500000);
    CHECK(odkit_handle_timeout(ODKIT_NODE, 501000) == ODKIT_OK);
    expect(0x707, "\x7F", 1);
    CHECK(ticks >= 2);
    /* What the firmware sets asks nobody, and services follow. */
    refusal = ODKIT_ABORT_LOCAL;
    CHECK(odkit_set_u32(ODKIT_NODE, 501000, HEARTBEAT, 0) == ODKIT_OK);
    CHECK(writes == 1);
    refusal = 0;
    /* A live value. */
    send(501000, 0x607, "\x40\x00\x60\x01\x00\x00\x00\x00", 8);
    expect(0x587, "\x4F\x00\x60\x01\x2A\x00\x00\x00", 8);
    CHECK(refreshes > 0);
}

static void errors(void)
{
    static const uint8_t info[5] = {1, 2, 3, 4, 5};
    CHECK(odkit_raise(ODKIT_NODE, 600000, 0, 1, NULL) == ODKIT_ARGUMENT);
    CHECK(odkit_raise(ODKIT_NODE, 600000, 0x4200, 0x09, info) == ODKIT_OK);
    expect(0x87, "\x00\x42\x09\x01\x02\x03\x04\x05", 8);
    CHECK(event(ODKIT_EVENT_ERROR).value == 0x4200);
    CHECK(odkit_raise(ODKIT_NODE, 600000, 0x4200, 0x09, info) == ODKIT_OK); /* again: no message */
    CHECK(odkit_clear(ODKIT_NODE, 600000, 0x4200, 0x09, NULL) == ODKIT_OK);
    expect(0x87, "\x00\x00\x00\x00\x00\x00\x00\x00", 8);
    CHECK(event(ODKIT_EVENT_ERROR_CLEARED).value == 0x4200);
}

/* The counter wraps after 71 minutes; the heartbeat comes all the same. */
static void wraps(void)
{
    uint32_t now = 0xFFF00000u;
    odkit_frame frame;
    int beats = 0;
    CHECK(odkit_power_off(ODKIT_NODE) == ODKIT_OK);
    CHECK(odkit_power_on(ODKIT_NODE, now, 7, NULL) == ODKIT_OK);
    CHECK(odkit_poll_frame(ODKIT_NODE, &frame));
    CHECK(odkit_set_u32(ODKIT_NODE, now, HEARTBEAT, 60000) == ODKIT_OK);
    for (int minute = 0; minute < 300; minute++) {
        uint32_t wait = odkit_poll_timeout(ODKIT_NODE, now);
        CHECK(wait == 60000000u);
        now += wait;
        CHECK(odkit_poll_timeout(ODKIT_NODE, now) == 0);
        CHECK(odkit_handle_timeout(ODKIT_NODE, now) == ODKIT_OK);
        while (odkit_poll_frame(ODKIT_NODE, &frame)) {
            beats++;
        }
        /* A clock that runs back, as that of another core, moves nothing. */
        CHECK(odkit_handle_timeout(ODKIT_NODE, now - 1000) == ODKIT_OK);
        CHECK(odkit_poll_timeout(ODKIT_NODE, now) == 60000000u);
    }
    CHECK(beats == 300);
}

/* A node without a node ID: LSS gives it one. */
static void lss(void)
{
    odkit_frame frame;
    CHECK(odkit_power_on(ODKIT_NODE, 0, ODKIT_UNCONFIGURED, NULL) == ODKIT_OK);
    CHECK(odkit_node_id(ODKIT_NODE) == ODKIT_UNCONFIGURED);
    CHECK(!odkit_poll_frame(ODKIT_NODE, &frame));
    send(0, 0x7E5, "\x04\x01\x00\x00\x00\x00\x00\x00", 8);
    send(0, 0x7E5, "\x11\x09\x00\x00\x00\x00\x00\x00", 8);
    expect(0x7E4, "\x11\x00\x00\x00\x00\x00\x00\x00", 8);
    send(0, 0x7E5, "\x13\x00\x03\x00\x00\x00\x00\x00", 8); /* 250 kbit/s */
    expect(0x7E4, "\x13\x00\x00\x00\x00\x00\x00\x00", 8);
    send(0, 0x7E5, "\x15\x01\x00\x00\x00\x00\x00\x00", 8);
    CHECK(odkit_handle_timeout(ODKIT_NODE, 1000) == ODKIT_OK);
    CHECK(event(ODKIT_EVENT_BIT_RATE).value == 250);
    CHECK(odkit_handle_timeout(ODKIT_NODE, 2000) == ODKIT_OK);
    send(2000, 0x7E5, "\x04\x00\x00\x00\x00\x00\x00\x00", 8);
    expect(0x709, "\x00", 1);
    CHECK(odkit_node_id(ODKIT_NODE) == 9);
    CHECK(odkit_power_off(ODKIT_NODE) == ODKIT_OK);
}

int main(void)
{
    odkit_device the_device = device();
    memset(memory, 0xFF, sizeof memory);
    without_power();
    wrong_devices();
    CHECK(odkit_power_on(ODKIT_NODE, 1000, 7, &the_device) == ODKIT_OK);
    CHECK(odkit_power_on(ODKIT_NODE, 1000, 7, &the_device) == ODKIT_STATE);
    CHECK(resets == 1 && odkit_node_id(ODKIT_NODE) == 7);
    expect(0x707, "\x00", 1);
    CHECK(odkit_state(ODKIT_NODE) == ODKIT_PRE_OPERATIONAL);
    CHECK(event(ODKIT_EVENT_RESET).sub == 7);
    CHECK(event(ODKIT_EVENT_STATE).value == ODKIT_PRE_OPERATIONAL);
    values();
    frames();
    errors();
    send(700000, 0x607, "\x23\x10\x10\x01save", 8);
    expect(0x587, "\x60\x10\x10\x01\x00\x00\x00\x00", 8);
    CHECK(saves > 0 && event(ODKIT_EVENT_SAVED).sub == 1);
    send(700000, 0, "\x81\x00", 2);
    CHECK(resets == 2);
    expect(0x707, "\x00", 1);
    wraps();
    CHECK(odkit_power_off(ODKIT_NODE) == ODKIT_OK);
    lss();
    printf("%d checks\n", checks);
    return EXIT_SUCCESS;
}
