/* A board in virtual time: what happens to it is in a file, and what it sends goes to another.
 *
 * An entry of the file is a letter, the time (8 bytes of microseconds, as all numbers little-endian)
 * and what belongs to the letter:
 *
 *   N  a new device              4 bytes of EEPROM capacity, all of it FFh
 *   E  content of the EEPROM     all its bytes
 *   +  power comes               node ID
 *   -  power goes
 *   F  a frame is received       4 bytes of identifier (bit 31: extended, bit 30: remote), length, 8 bytes
 *   T  nothing, but the time
 *   C  something changed outside
 *   B  the CAN controller        state
 *   V  the firmware sets a value index (2), sub-index, length, bytes
 *   X  an error of the device    code (2), register, 5 bytes, 1: comes, 0: goes
 *   G  a value is asked for      index (2), sub-index
 *   D  the EEPROM is asked for
 *
 * The answers: `f`, time and a frame as above; `g`, the result (4), the length (2) and the value;
 * `d` and the EEPROM; `r`, the kbit/s (4) that LSS activated.
 */
#include "odkit_objects.h"
#include "virtual.h"

/* The counter of the board wraps after ten seconds: nothing may depend on where it is. */
#define COUNTER_AT_START (0u - 10000000u)

#define EEPROM_ROOM 16384u

static uint64_t now;
static uint8_t eeprom[EEPROM_ROOM];
static uint32_t eeprom_size;

/* The next entry: its letter, 0 if it has not been read yet, and its time. */
static uint8_t next;
static uint64_t next_at;

static odkit_frame received;
static bool has_received;

/* What the device does when power comes. */
static void (*device_power_on)(uint8_t node_id);

static uint8_t get_byte(void)
{
    uint8_t byte = 0;
    if (!virtual_read(&byte, 1)) {
        board_fail();
    }
    return byte;
}

static uint64_t get_number(unsigned bytes)
{
    uint64_t number = 0;
    for (unsigned at = 0; at < bytes; at++) {
        number |= (uint64_t)get_byte() << (8 * at);
    }
    return number;
}

static void put_number(uint64_t number, unsigned bytes)
{
    uint8_t out[8];
    for (unsigned at = 0; at < bytes; at++) {
        out[at] = (uint8_t)(number >> (8 * at));
    }
    virtual_write(out, bytes);
}

static void put_letter(char letter)
{
    put_number((uint8_t)letter, 1);
}

static void get_bytes(uint8_t *to, uint32_t len)
{
    if (!virtual_read(to, len)) {
        board_fail();
    }
}

static void check(uint32_t result)
{
    if (result != ODKIT_OK) {
        board_fail();
    }
}

static void get_frame(void)
{
    uint32_t id = (uint32_t)get_number(4);
    received.flags = (uint8_t)((id >> 31 ? ODKIT_EXTENDED : 0) | (id >> 30 & 1 ? ODKIT_REMOTE : 0));
    received.id = id & 0x1FFFFFFFu;
    received.len = get_byte();
    get_bytes(received.data, sizeof received.data);
    has_received = true;
}

static void set_value(void)
{
    uint8_t value[255];
    uint16_t index = (uint16_t)get_number(2);
    uint8_t sub = get_byte();
    uint8_t len = get_byte();
    get_bytes(value, len);
    check(odkit_set(ODKIT_NODE, board_now_us(), index, sub, value, len));
}

static void change_error(void)
{
    uint8_t info[5];
    uint16_t code = (uint16_t)get_number(2);
    uint8_t bits = get_byte();
    get_bytes(info, sizeof info);
    if (get_byte()) {
        check(odkit_raise(ODKIT_NODE, board_now_us(), code, bits, info));
    } else {
        check(odkit_clear(ODKIT_NODE, board_now_us(), code, bits, info));
    }
}

static void show_value(void)
{
    static uint8_t value[2048];
    size_t len = 0;
    uint16_t index = (uint16_t)get_number(2);
    uint8_t sub = get_byte();
    uint32_t result = odkit_get(ODKIT_NODE, index, sub, value, sizeof value, &len);
    put_letter('g');
    put_number(result, 4);
    put_number(len, 2);
    virtual_write(value, (uint32_t)len);
}

/* Does what the next entry says. */
static void act(void)
{
    uint8_t letter = next;
    next = 0;
    switch (letter) {
    case 'N':
        (void)odkit_power_off(ODKIT_NODE);
        eeprom_size = (uint32_t)get_number(4);
        if (eeprom_size > sizeof eeprom) {
            board_fail();
        }
        for (uint32_t at = 0; at < eeprom_size; at++) {
            eeprom[at] = 0xFF;
        }
        break;
    case 'E':
        get_bytes(eeprom, eeprom_size);
        break;
    case '+':
        device_power_on(get_byte());
        break;
    case '-':
        check(odkit_power_off(ODKIT_NODE));
        break;
    case 'F':
        get_frame();
        break;
    case 'T':
        break;
    case 'C':
        (void)odkit_handle_change(ODKIT_NODE, board_now_us());
        break;
    case 'B':
        (void)odkit_handle_bus(ODKIT_NODE, board_now_us(), get_byte());
        break;
    case 'V':
        set_value();
        break;
    case 'X':
        change_error();
        break;
    case 'G':
        show_value();
        break;
    case 'D':
        put_letter('d');
        virtual_write(eeprom, eeprom_size);
        break;
    default:
        board_fail();
    }
}

void board_start(void (*power_on)(uint8_t node_id))
{
    device_power_on = power_on;
    virtual_open();
}

uint32_t board_now_us(void)
{
    return (uint32_t)now + COUNTER_AT_START;
}

void board_sleep(uint32_t us)
{
    if (next == 0) {
        if (!virtual_read(&next, 1)) {
            virtual_end(true);
        }
        next_at = get_number(8);
    }
    /* A new device has a clock of its own. */
    if (next != 'N' && now + us < next_at) {
        now += us;
        return;
    }
    now = next_at;
    act();
}

bool board_receive(odkit_frame *frame)
{
    bool has = has_received;
    *frame = received;
    has_received = false;
    return has;
}

bool board_can_send(void)
{
    return true;
}

void board_send(const odkit_frame *frame)
{
    uint32_t flags = (frame->flags & ODKIT_EXTENDED ? 1u << 31 : 0) |
                     (frame->flags & ODKIT_REMOTE ? 1u << 30 : 0);
    put_letter('f');
    put_number(now, 8);
    put_number(frame->id | flags, 4);
    put_number(frame->len, 1);
    virtual_write(frame->data, sizeof frame->data);
}

void board_bit_rate(uint32_t kbit)
{
    put_letter('r');
    put_number(kbit, 4);
}

void board_led(uint8_t state)
{
    (void)state;
}

uint32_t board_serial_number(void)
{
    return 0;
}

uint32_t board_eeprom_size(void)
{
    return eeprom_size;
}

bool board_eeprom_read(uint32_t offset, uint8_t *to, uint32_t len)
{
    if (offset > eeprom_size || len > eeprom_size - offset) {
        return false;
    }
    for (uint32_t at = 0; at < len; at++) {
        to[at] = eeprom[offset + at];
    }
    return true;
}

bool board_eeprom_write(uint32_t offset, const uint8_t *from, uint32_t len)
{
    if (offset > eeprom_size || len > eeprom_size - offset) {
        return false;
    }
    for (uint32_t at = 0; at < len; at++) {
        eeprom[offset + at] = from[at];
    }
    return true;
}

void board_fail(void)
{
    virtual_end(false);
}
