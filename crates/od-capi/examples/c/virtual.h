/* What the board in virtual time needs of the computer that it runs on. */
#ifndef VIRTUAL_H
#define VIRTUAL_H

#include "board.h"

/* Opens the files `told` and `answers`. */
void virtual_open(void);
/* Reads so many bytes of `told`; false at its end. */
bool virtual_read(uint8_t *to, uint32_t len);
/* Writes to `answers`. */
void virtual_write(const uint8_t *from, uint32_t len);
/* Ends the program. */
void virtual_end(bool well);

#endif
