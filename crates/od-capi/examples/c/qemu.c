/* The board in virtual time on an emulated Cortex-M3 (lm3s6965evb), and what happens before main. */
#include "virtual.h"

#define ROOM 2048u

extern uint32_t data_load[], data_start[], data_end[], bss_start[], bss_end[], stack_top[];

int main(void);
void reset(void);

/* The vector table: there are no interrupts. */
__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    void (*reset)(void);
} vectors = {stack_top, reset};

void reset(void)
{
    const uint32_t *from = data_load;
    for (uint32_t *to = data_start; to < data_end; to++) {
        *to = *from++;
    }
    for (uint32_t *to = bss_start; to < bss_end; to++) {
        *to = 0;
    }
    (void)main();
}

/* Asks the emulator. */
static uint32_t semihosting(uint32_t operation, const void *parameter)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = parameter;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static uint32_t open(const char *name, uint32_t len, uint32_t mode)
{
    uint32_t block[3] = {(uint32_t)name, mode, len};
    return semihosting(0x01, block);
}

static uint32_t told;
static uint32_t answers;
static uint8_t in[ROOM], out[ROOM];
static uint32_t in_at, in_end, out_len;

void virtual_open(void)
{
    told = open("told", 4, 1);
    answers = open("answers", 7, 5);
}

bool virtual_read(uint8_t *to, uint32_t len)
{
    for (uint32_t at = 0; at < len; at++) {
        if (in_at == in_end) {
            uint32_t block[3] = {told, (uint32_t)in, ROOM};
            in_at = 0;
            in_end = ROOM - semihosting(0x06, block);
            if (in_end == 0) {
                return false;
            }
        }
        to[at] = in[in_at++];
    }
    return true;
}

static void flush(void)
{
    uint32_t block[3] = {answers, (uint32_t)out, out_len};
    (void)semihosting(0x05, block);
    out_len = 0;
}

void virtual_write(const uint8_t *from, uint32_t len)
{
    for (uint32_t at = 0; at < len; at++) {
        if (out_len == ROOM) {
            flush();
        }
        out[out_len++] = from[at];
    }
}

void virtual_end(bool well)
{
    flush();
    (void)semihosting(0x18, (const void *)(well ? 0x20026u : 0x20023u));
    for (;;) {
    }
}

/* The library found a fault of its own. */
void odkit_panic(void)
{
    virtual_end(false);
}
