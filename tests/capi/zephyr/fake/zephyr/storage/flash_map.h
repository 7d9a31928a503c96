/* The part of Zephyr's map of flash partitions that the module of odkit uses. */
#ifndef FAKE_FLASH_MAP_H
#define FAKE_FLASH_MAP_H

#include <sys/types.h>
#include <zephyr/kernel.h>

struct flash_area {
    uint8_t fa_id;
    off_t fa_off;
    size_t fa_size;
    const struct device *fa_dev;
};
int flash_area_open(uint8_t id, const struct flash_area **area);
int flash_area_read(const struct flash_area *area, off_t offset, void *to, size_t len);
int flash_area_write(const struct flash_area *area, off_t offset, const void *from, size_t len);
int flash_area_erase(const struct flash_area *area, off_t offset, size_t len);
uint32_t flash_area_align(const struct flash_area *area);
const struct device *flash_area_get_device(const struct flash_area *area);
#define FIXED_PARTITION_ID(label) 7

#endif
