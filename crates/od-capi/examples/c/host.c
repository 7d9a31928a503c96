/* The board in virtual time on a computer. */
#include <stdio.h>
#include <stdlib.h>

#include "virtual.h"

static FILE *told;
static FILE *answers;

void virtual_open(void)
{
    told = fopen("told", "rb");
    answers = fopen("answers", "wb");
    if (!told || !answers) {
        exit(EXIT_FAILURE);
    }
}

bool virtual_read(uint8_t *to, uint32_t len)
{
    return fread(to, 1, len, told) == len;
}

void virtual_write(const uint8_t *from, uint32_t len)
{
    if (fwrite(from, 1, len, answers) != len) {
        exit(EXIT_FAILURE);
    }
}

void virtual_end(bool well)
{
    if (fclose(answers) != 0) {
        well = false;
    }
    (void)fclose(told);
    exit(well ? EXIT_SUCCESS : EXIT_FAILURE);
}
