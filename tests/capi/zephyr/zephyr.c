/* The module and the sample of Zephyr on a kernel, a CAN controller and a flash of the headers in `fake`.
 *
 * The node's thread sleeps in k_sem_take. While nothing is on the line, the next step of the test runs there: it looks at
 * what was sent, and does something else to the node. */
#include <errno.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <zephyr/drivers/can.h>
#include <zephyr/drivers/flash.h>
#include <zephyr/storage/flash_map.h>

#include "odkit.h"
#include "odkit_objects.h"
#include "odkit_zephyr.h"

#define CHECK(condition) check((condition), #condition, __LINE__)

static int checks;

static void check(bool holds, const char *text, int line)
{
    checks++;
    if (!holds) {
        printf("line %d: %s\n", line, text);
        exit(EXIT_FAILURE);
    }
}

/* ---- Kernel ---- */

static uint64_t now_us = 5000000;
/* Leaves the sample, and leaves its second thread. */
static jmp_buf end, slept;

int k_mutex_init(struct k_mutex *mutex)
{
    mutex->locks = 0;
    return 0;
}

int k_mutex_lock(struct k_mutex *mutex, k_timeout_t timeout)
{
    CHECK(timeout.us == -1 && mutex->locks == 0);
    mutex->locks++;
    return 0;
}

int k_mutex_unlock(struct k_mutex *mutex)
{
    mutex->locks--;
    CHECK(mutex->locks == 0);
    return 0;
}

int k_sem_init(struct k_sem *sem, unsigned int count, unsigned int limit)
{
    sem->count = count;
    sem->limit = limit;
    return 0;
}

void k_sem_give(struct k_sem *sem)
{
    sem->count += sem->count < sem->limit;
}

void k_msgq_init(struct k_msgq *queue, char *buffer, size_t size, uint32_t most)
{
    queue->buffer = buffer;
    queue->size = size;
    queue->most = most;
    queue->used = 0;
}

int k_msgq_put(struct k_msgq *queue, const void *data, k_timeout_t timeout)
{
    CHECK(timeout.us == 0);
    if (queue->used == queue->most) {
        return -ENOMSG;
    }
    memcpy(queue->buffer + queue->used++ * queue->size, data, queue->size);
    return 0;
}

int k_msgq_get(struct k_msgq *queue, void *data, k_timeout_t timeout)
{
    CHECK(timeout.us == 0);
    if (queue->used == 0) {
        return -ENOMSG;
    }
    memcpy(data, queue->buffer, queue->size);
    queue->used--;
    memmove(queue->buffer, queue->buffer + queue->size, queue->used * queue->size);
    return 0;
}

atomic_val_t atomic_get(const atomic_t *target)
{
    return *target;
}

atomic_val_t atomic_set(atomic_t *target, atomic_val_t value)
{
    atomic_val_t before = *target;
    *target = value;
    return before;
}

atomic_val_t atomic_clear(atomic_t *target)
{
    return atomic_set(target, 0);
}

int64_t k_uptime_ticks(void)
{
    return (int64_t)(now_us / 100);
}

uint64_t k_ticks_to_us_floor64(uint64_t ticks)
{
    return ticks * 100;
}

int32_t k_msleep(int32_t ms)
{
    CHECK(ms > 0);
    longjmp(slept, 1);
}

void k_panic(void)
{
    abort();
}

bool device_is_ready(const struct device *device)
{
    return device == &the_can;
}

/* ---- CAN controller: one mailbox ---- */

const struct device the_can = {1}, the_flash = {2};
static uint32_t bitrate;
static bool is_started, is_off, has_no_room;
static can_rx_callback_t on_receive;
static can_state_change_callback_t on_change;
static void *of_receive, *of_change;
/* The frame in the mailbox. */
static struct can_frame sending;
static can_tx_callback_t on_end;
static void *of_end;
/* Frames on the bus that no step has looked at. */
static struct can_frame sent[8];
static size_t count;

int can_start(const struct device *can)
{
    CHECK(can == &the_can && !is_started && bitrate != 0);
    is_started = true;
    return 0;
}

int can_stop(const struct device *can)
{
    CHECK(can == &the_can && is_started);
    is_started = false;
    on_end = NULL;
    return 0;
}

int can_set_bitrate(const struct device *can, uint32_t rate)
{
    CHECK(can == &the_can && !is_started);
    bitrate = rate;
    return 0;
}

int can_send(const struct device *can, const struct can_frame *frame, k_timeout_t timeout,
             can_tx_callback_t callback, void *user)
{
    CHECK(can == &the_can && is_started && timeout.us == 0);
    /* One frame at a time. */
    CHECK(on_end == NULL);
    if (is_off) {
        return -ENETUNREACH;
    }
    if (has_no_room) {
        return -EAGAIN;
    }
    sending = *frame;
    on_end = callback;
    of_end = user;
    return 0;
}

int can_add_rx_filter(const struct device *can, can_rx_callback_t callback, void *user,
                      const struct can_filter *filter)
{
    CHECK(can == &the_can && filter->mask == 0 && filter->flags == 0);
    on_receive = callback;
    of_receive = user;
    return 0;
}

void can_set_state_change_callback(const struct device *can, can_state_change_callback_t callback,
                                   void *user)
{
    CHECK(can == &the_can);
    on_change = callback;
    of_change = user;
}

/* ---- Flash: four pages of 256 bytes, words of 8 ---- */

static uint8_t flash[4 * 256];
static int erasures;

static const struct flash_area area = {7, 0x10000, sizeof flash, &the_flash};

int flash_get_page_info_by_offs(const struct device *device, off_t offset,
                                struct flash_pages_info *info)
{
    CHECK(device == &the_flash && offset == 0x10000);
    info->start_offset = offset;
    info->size = 256;
    info->index = 256;
    return 0;
}

int flash_area_open(uint8_t id, const struct flash_area **to)
{
    *to = &area;
    return id == 7 ? 0 : -ENOENT;
}

int flash_area_read(const struct flash_area *from, off_t offset, void *to, size_t len)
{
    CHECK(from == &area && (size_t)offset + len <= sizeof flash);
    memcpy(to, flash + offset, len);
    return 0;
}

int flash_area_write(const struct flash_area *to, off_t offset, const void *from, size_t len)
{
    CHECK(to == &area && (size_t)offset + len <= sizeof flash);
    CHECK(offset % 8 == 0 && len % 8 == 0);
    for (size_t at = 0; at < len; at++) {
        flash[(size_t)offset + at] &= ((const uint8_t *)from)[at];
    }
    return 0;
}

int flash_area_erase(const struct flash_area *of, off_t offset, size_t len)
{
    CHECK(of == &area && offset % 256 == 0 && len == 256);
    memset(flash + offset, 0xFF, len);
    erasures++;
    return 0;
}

uint32_t flash_area_align(const struct flash_area *of)
{
    CHECK(of == &area);
    return 8;
}

const struct device *flash_area_get_device(const struct flash_area *of)
{
    return of->fa_dev;
}

/* ---- Steps ---- */

static size_t step;

extern void (*const sampling_thread)(void *, void *, void *);
int sample_main(void);

static void frame(uint32_t id, uint8_t flags, const char *data, uint8_t len)
{
    struct can_frame made;
    memset(&made, 0, sizeof made);
    made.id = id;
    made.flags = flags;
    made.dlc = len;
    memcpy(made.data, data, len);
    on_receive(&the_can, &made, of_receive);
}

/* The oldest frame that was sent is this one. */
static void expect(uint32_t id, const char *data, size_t len)
{
    CHECK(count > 0 && sent[0].id == id && sent[0].flags == 0 && sent[0].dlc == len);
    CHECK(memcmp(sent[0].data, data, len) == 0);
    memmove(sent, sent + 1, --count * sizeof *sent);
}

static void nothing(void)
{
    CHECK(count == 0);
}

static void run_thread(void)
{
    if (setjmp(slept) == 0) {
        sampling_thread(NULL, NULL, NULL);
    }
}

static void boots_up(void)
{
    CHECK(bitrate == 500000 && is_started);
    expect(0x705, "\x00", 1);
    run_thread();
}

static void the_thread_sets_a_value(void)
{
    nothing();
    frame(0x605, 0, "\x40\x00\x20\x00\x00\x00\x00\x00", 8);
}

static void sdo_uploads_the_value(void)
{
    expect(0x585, "\x4B\x00\x20\x00\xD7\x00\x00\x00", 8);
    /* Frames that are not for the node: extended, and of CAN FD. */
    frame(0x605, CAN_FRAME_IDE, "\x40\x00\x20\x00\x00\x00\x00\x00", 8);
    frame(0x605, CAN_FRAME_FDF, "\x40\x00\x20\x00\x00\x00\x00\x00", 8);
}

static void other_frames_are_ignored(void)
{
    nothing();
    /* 2001h := 1600: the callback refuses. */
    frame(0x605, 0, "\x2B\x01\x20\x00\x40\x06\x00\x00", 8);
}

static void the_callback_refuses(void)
{
    expect(0x585, "\x80\x01\x20\x00\x31\x00\x09\x06", 8);
    frame(0x605, 0, "\x2B\x01\x20\x00\xC8\x00\x00\x00", 8);
}

static void a_limit_is_set(void)
{
    expect(0x585, "\x60\x01\x20\x00\x00\x00\x00\x00", 8);
    frame(0, 0, "\x01\x05", 2);
}

static void operational(void)
{
    /* The value of the event-driven TPDO is sent at the start. */
    expect(0x185, "\xD7\x00", 2);
    run_thread();
}

static void too_hot(void)
{
    expect(0x085, "\x00\x42\x09\x00\x00\x00\x00\x00", 8);
    /* Six frames at once, and room for four. */
    for (int number = 0; number < 6; number++) {
        frame(0x605, 0, "\x40\x01\x20\x00\x00\x00\x00\x00", 8);
    }
}

static void a_lost_frame_is_reported(void)
{
    bool has_overrun = false, has_response = false;
    while (count > 0) {
        has_overrun |= sent[0].id == 0x085 && memcmp(sent[0].data, "\x10\x81", 2) == 0;
        has_response |= sent[0].id == 0x585;
        expect(sent[0].id, (const char *)sent[0].data, sent[0].dlc);
    }
    CHECK(has_overrun && has_response);
    frame(0x605, 0, "\x23\x10\x10\x01save", 8);
}

static void values_are_saved(void)
{
    expect(0x585, "\x60\x10\x10\x01\x00\x00\x00\x00", 8);
    CHECK(erasures > 0);
    /* The controller is full of frames of others. */
    has_no_room = true;
    frame(0x605, 0, "\x40\x01\x20\x00\x00\x00\x00\x00", 8);
}

static void a_full_controller_is_asked_again(void)
{
    nothing();
    has_no_room = false;
}

static void the_frame_is_sent_then(void)
{
    struct can_bus_err_cnt errors = {255, 0};
    expect(0x585, "\x4B\x01\x20\x00\xC8\x00\x00\x00", 8);
    is_off = true;
    on_change(&the_can, CAN_STATE_BUS_OFF, errors, of_change);
}

static void bus_off(void)
{
    struct can_bus_err_cnt errors = {0, 0};
    nothing();
    frame(0x605, 0, "\x40\x01\x20\x00\x00\x00\x00\x00", 8);
    is_off = false;
    on_change(&the_can, CAN_STATE_ERROR_ACTIVE, errors, of_change);
}

static void back_from_bus_off(void)
{
    bool is_told = false;
    for (size_t at = 0; at < count; at++) {
        is_told |= sent[at].id == 0x085 && memcmp(sent[at].data, "\x40\x81", 2) == 0;
    }
    CHECK(is_told);
    count = 0;
    frame(0x605, 0, "\x40\x01\x20\x00\x00\x00\x00\x00", 8);
}

static void lss_sets_a_bit_rate(void)
{
    CHECK(count > 0 && sent[count - 1].id == 0x585);
    count = 0;
    frame(0x7E5, 0, "\x04\x01\x00\x00\x00\x00\x00\x00", 8);
    frame(0x7E5, 0, "\x13\x00\x03\x00\x00\x00\x00\x00", 8);
    frame(0x7E5, 0, "\x15\x0A\x00\x00\x00\x00\x00\x00", 8);
}

static void power_is_lost(void)
{
    /* The switch delay is 10 ms. */
    if (bitrate == 500000) {
        step--;
        return;
    }
    CHECK(bitrate == 250000 && is_started);
    CHECK(odkit_power_off(ODKIT_NODE) == ODKIT_OK);
    CHECK(can_stop(&the_can) == 0);
    longjmp(end, 1);
}

static void saved_values_are_loaded(void)
{
    int32_t limit = 0;
    expect(0x705, "\x00", 1);
    CHECK(odkit_get_i32(ODKIT_NODE, OD_LIMIT, &limit) == ODKIT_OK && limit == 200);
    longjmp(end, 3);
}

static void (*const steps[])(void) = {
    boots_up,
    the_thread_sets_a_value,
    sdo_uploads_the_value,
    other_frames_are_ignored,
    the_callback_refuses,
    a_limit_is_set,
    operational,
    too_hot,
    a_lost_frame_is_reported,
    values_are_saved,
    a_full_controller_is_asked_again,
    the_frame_is_sent_then,
    bus_off,
    back_from_bus_off,
    lss_sets_a_bit_rate,
    power_is_lost,
    saved_values_are_loaded,
};
/* The thread of the node sleeps. */
int k_sem_take(struct k_sem *sem, k_timeout_t timeout)
{
    CHECK(timeout.us >= 0 && timeout.us <= 1 << 30);
    now_us += 200;
    if (sem->count == 0 && on_end != NULL) {
        can_tx_callback_t call = on_end;
        CHECK(count < sizeof sent / sizeof *sent);
        sent[count++] = sending;
        on_end = NULL;
        call(&the_can, 0, of_end);
    } else if (sem->count == 0) {
        CHECK(step < sizeof steps / sizeof *steps);
        steps[step++]();
        if (sem->count == 0) {
            now_us += (uint64_t)(timeout.us < 1000 ? timeout.us : 1000);
            return -EAGAIN;
        }
    }
    sem->count = 0;
    return 0;
}

int main(void)
{
    struct odkit_zephyr bad;
    memset(flash, 0xFF, sizeof flash);
    /* What cannot start. */
    memset(&bad, 0, sizeof bad);
    bad.can = &the_flash;
    CHECK(odkit_zephyr_start(&bad) == -ENODEV);
    bad.can = &the_can;
    bad.kbit = 500;
    CHECK(odkit_zephyr_start(&bad) == -EINVAL);
    bad.node_id = 5;
    bad.node = 1;
    CHECK(odkit_zephyr_start(&bad) == -EINVAL);
    bad.node = ODKIT_NODE;
    bad.has_partition = true;
    bad.partition = 8;
    CHECK(odkit_zephyr_start(&bad) == -ENOENT);
    CHECK(!is_started);
    /* From here on the sample runs, until a step leaves it. */
    switch (setjmp(end)) {
    case 0:
    case 1:
        (void)sample_main();
        break;
    default:
        printf("%d checks\n", checks);
        return EXIT_SUCCESS;
    }
    return EXIT_FAILURE;
}
