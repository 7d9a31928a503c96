/* A CANopen device in C: a loop around the node of odkit, values saved in an EEPROM, and a LED. */
#include "board.h"
#include "odkit.h"
#include "odkit_objects.h"

/* The memory of the saved values. */
static int32_t eeprom_read(void *context, uint32_t offset, uint8_t *to, uint32_t len)
{
    (void)context;
    return board_eeprom_read(offset, to, len) ? 0 : -1;
}

static int32_t eeprom_write(void *context, uint32_t offset, const uint8_t *from, uint32_t len)
{
    (void)context;
    return board_eeprom_write(offset, from, len) ? 0 : -1;
}

/* Values were loaded: the serial number of this board replaces that of the EDS. */
static void on_reset(void *context, uint8_t reset)
{
    (void)context;
    (void)reset;
#ifdef OD_IDENTITY_OBJECT_SERIAL_NUMBER
    if (board_serial_number() != 0) {
        (void)odkit_set_u32(ODKIT_NODE, 0, OD_IDENTITY_OBJECT_SERIAL_NUMBER, board_serial_number());
    }
#endif
}

/* Sends what the node has to send, as long as the CAN controller has room. */
static void send_frames(void)
{
    odkit_frame frame;
    while (board_can_send() && odkit_poll_frame(ODKIT_NODE, &frame)) {
        board_send(&frame);
    }
}

/* What happened: the LED shows the NMT state (CiA 303-3). */
static void look_at_events(void)
{
    odkit_event event;
    while (odkit_poll_event(ODKIT_NODE, &event)) {
        switch (event.kind) {
        case ODKIT_EVENT_STATE:
            board_led((uint8_t)event.value);
            break;
        case ODKIT_EVENT_BIT_RATE:
            board_bit_rate(event.value);
            break;
        default:
            break;
        }
    }
}

static void power_on(uint8_t node_id)
{
    odkit_device device = {0};
    device.reset = on_reset;
    device.storage.capacity = board_eeprom_size();
    device.storage.read = eeprom_read;
    device.storage.write = eeprom_write;
    if (odkit_power_on(ODKIT_NODE, board_now_us(), node_id, &device) != ODKIT_OK) {
        board_fail();
    }
}

int main(void)
{
    board_start(power_on);
    for (;;) {
        odkit_frame frame;
        uint32_t now = board_now_us();
        send_frames();
        if (board_receive(&frame)) {
            (void)odkit_handle_frame(ODKIT_NODE, now, &frame);
        } else if (odkit_poll_timeout(ODKIT_NODE, now) == 0) {
            (void)odkit_handle_timeout(ODKIT_NODE, now);
        } else {
            look_at_events();
            board_sleep(odkit_poll_timeout(ODKIT_NODE, now));
        }
    }
}
