/* A thermometer: 2000h is its temperature in tenths of a degree, 2001h the limit above which it reports an error. */
#include <zephyr/kernel.h>
#include <zephyr/storage/flash_map.h>

#include "odkit_objects.h"
#include "odkit_zephyr.h"

/* A limit that a master writes is one of the sensor. */
static uint32_t on_validate(void *context, uint16_t index, uint8_t sub, const uint8_t *value, size_t len)
{
	ARG_UNUSED(context);
	switch (ODKIT_KEY(index, sub)) {
	case ODKIT_KEY(OD_LIMIT):
		return len == 2 && (int16_t)(value[0] | value[1] << 8) > 1500 ? ODKIT_ABORT_TOO_HIGH : ODKIT_OK;
	default:
		return ODKIT_OK;
	}
}

static struct odkit_zephyr node = {
	.node = ODKIT_NODE,
	.can = DEVICE_DT_GET(DT_CHOSEN(zephyr_canbus)),
	.kbit = 500,
	.node_id = 5,
	.device = {.validate = on_validate},
	.has_partition = true,
	.partition = FIXED_PARTITION_ID(storage_partition),
};

/* Read your sensor here. */
static int32_t sensor(void)
{
	return 215;
}

/* Another thread: it locks the node for its calls, and event-driven TPDOs follow. */
static void sample(void *a, void *b, void *c)
{
	ARG_UNUSED(a);
	ARG_UNUSED(b);
	ARG_UNUSED(c);
	for (;;) {
		uint32_t now = odkit_zephyr_now();
		int32_t limit = 0;

		odkit_zephyr_lock(&node);
		(void)odkit_set_i32(ODKIT_NODE, now, OD_TEMPERATURE, sensor());
		if (odkit_get_i32(ODKIT_NODE, OD_LIMIT, &limit) == ODKIT_OK && sensor() > limit) {
			(void)odkit_raise(ODKIT_NODE, now, 0x4200, 0x09, NULL);
		} else {
			(void)odkit_clear(ODKIT_NODE, now, 0x4200, 0x09, NULL);
		}
		odkit_zephyr_unlock(&node);
		k_msleep(100);
	}
}

K_THREAD_DEFINE(sampling, 1024, sample, NULL, NULL, NULL, 7, 0, 1000);

int main(void)
{
	int error = odkit_zephyr_start(&node);

	if (error != 0) {
		return error;
	}
	odkit_zephyr_run(&node);
	return 0;
}
