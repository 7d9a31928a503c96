/* What the device needs of its board. */
#ifndef BOARD_H
#define BOARD_H

#include "odkit.h"

/* Starts the board, which calls power_on with the node ID each time power comes. */
void board_start(void (*power_on)(uint8_t node_id));
/* Counts microseconds, modulo 2^32. */
uint32_t board_now_us(void);
/* Sleeps until a frame arrives, or this many microseconds at most. */
void board_sleep(uint32_t us);
/* Takes a frame that was received; false if nothing waits. */
bool board_receive(odkit_frame *frame);
/* Whether the CAN controller has room for a frame. */
bool board_can_send(void);
/* Gives the CAN controller a frame. */
void board_send(const odkit_frame *frame);
/* LSS activated a bit rate, in kbit/s. */
void board_bit_rate(uint32_t kbit);
/* Shows an NMT state. */
void board_led(uint8_t state);
/* The number of this one board; 0: none. */
uint32_t board_serial_number(void);
/* The EEPROM. */
uint32_t board_eeprom_size(void);
bool board_eeprom_read(uint32_t offset, uint8_t *to, uint32_t len);
bool board_eeprom_write(uint32_t offset, const uint8_t *from, uint32_t len);
/* Something is wrong that nothing can be done about. */
void board_fail(void);

#endif
