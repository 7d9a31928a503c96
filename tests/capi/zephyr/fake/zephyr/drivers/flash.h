/* The part of Zephyr's interface of flash that the module of odkit uses. */
#ifndef FAKE_FLASH_H
#define FAKE_FLASH_H

#include <sys/types.h>
#include <zephyr/kernel.h>

struct flash_pages_info {
    off_t start_offset;
    size_t size;
    uint32_t index;
};
int flash_get_page_info_by_offs(const struct device *flash, off_t offset,
                                struct flash_pages_info *info);

#endif
