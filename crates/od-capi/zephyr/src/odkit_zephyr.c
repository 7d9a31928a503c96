/* A node of odkit on a CAN controller of Zephyr: interrupts put frames into a queue and wake a thread, which calls the node. */
#include "odkit_zephyr.h"

#include <errno.h>
#include <string.h>

#ifdef CONFIG_ODKIT_STORAGE
#include <zephyr/drivers/flash.h>
#endif

/* Time after which a node with something due is asked again while the controller is busy, in microseconds. */
#define AGAIN_US 1000u

/* The library found an error in itself. */
void odkit_panic(void);
void odkit_panic(void)
{
	k_panic();
	for (;;) {
	}
}

uint32_t odkit_zephyr_now(void)
{
	return (uint32_t)k_ticks_to_us_floor64((uint64_t)k_uptime_ticks());
}

static void on_received(const struct device *can, struct can_frame *frame, void *user)
{
	struct odkit_zephyr *node = user;

	ARG_UNUSED(can);
	if (k_msgq_put(&node->received, frame, K_NO_WAIT) != 0) {
		atomic_set(&node->has_lost, 1);
	}
	k_sem_give(&node->wake);
}

static void on_sent(const struct device *can, int error, void *user)
{
	struct odkit_zephyr *node = user;

	ARG_UNUSED(can);
	ARG_UNUSED(error);
	atomic_set(&node->is_sending, 0);
	k_sem_give(&node->wake);
}

static void on_state(const struct device *can, enum can_state state, struct can_bus_err_cnt errors, void *user)
{
	struct odkit_zephyr *node = user;

	ARG_UNUSED(can);
	ARG_UNUSED(errors);
	atomic_set(&node->state, (atomic_val_t)state + 1);
	k_sem_give(&node->wake);
}

#ifdef CONFIG_ODKIT_STORAGE
static int32_t read_partition(void *context, uint32_t offset, uint8_t *to, uint32_t len)
{
	struct odkit_zephyr *node = context;

	return flash_area_read(node->area, (off_t)offset, to, len);
}

static int32_t write_partition(void *context, uint32_t offset, const uint8_t *from, uint32_t len)
{
	struct odkit_zephyr *node = context;

	return flash_area_write(node->area, (off_t)offset, from, len);
}

static int32_t erase_partition(void *context, uint32_t offset)
{
	struct odkit_zephyr *node = context;

	return flash_area_erase(node->area, (off_t)offset, node->device.storage.page);
}

/* The storage of the partition, in pages of its flash. */
static int open_partition(struct odkit_zephyr *node)
{
	odkit_storage *storage = &node->device.storage;
	struct flash_pages_info page;
	int error = flash_area_open(node->partition, &node->area);

	if (error != 0) {
		return error;
	}
	error = flash_get_page_info_by_offs(flash_area_get_device(node->area), node->area->fa_off, &page);
	if (error != 0) {
		return error;
	}
	storage->page = (uint32_t)page.size;
	storage->word = flash_area_align(node->area);
	storage->capacity = (uint32_t)(node->area->fa_size / page.size * page.size);
	storage->read = read_partition;
	storage->write = write_partition;
	storage->erase = erase_partition;
	storage->flush = NULL;
	return 0;
}
#endif

static int start_can(struct odkit_zephyr *node, uint32_t kbit)
{
	int error = can_set_bitrate(node->can, kbit * 1000u);

	return error != 0 ? error : can_start(node->can);
}

int odkit_zephyr_start(struct odkit_zephyr *node)
{
	static const struct can_filter all = {.flags = 0};
	int error;

	if (!device_is_ready(node->can)) {
		return -ENODEV;
	}
	k_mutex_init(&node->mutex);
	k_sem_init(&node->wake, 0, 1);
	k_msgq_init(&node->received, (char *)node->room, sizeof(node->room[0]), CONFIG_ODKIT_RX_QUEUE);
#ifdef CONFIG_ODKIT_STORAGE
	if (node->has_partition) {
		error = open_partition(node);
		if (error != 0) {
			return error;
		}
	}
#endif
	node->device.context = node;
	if (odkit_power_on(node->node, odkit_zephyr_now(), node->node_id, &node->device) != ODKIT_OK) {
		return -EINVAL;
	}
	can_set_state_change_callback(node->can, on_state, node);
	error = can_add_rx_filter(node->can, on_received, node, &all);
	if (error >= 0) {
		error = start_can(node, node->kbit);
	}
	if (error < 0) {
		(void)odkit_power_off(node->node);
		return error;
	}
	return 0;
}

/* Hands over what interrupts received. */
static void receive_frames(struct odkit_zephyr *node)
{
	atomic_val_t state = atomic_clear(&node->state);
	struct can_frame from;

	if (state != 0 && state - 1 != CAN_STATE_STOPPED) {
		static const uint8_t states[] = {ODKIT_BUS_ACTIVE, ODKIT_BUS_WARNING, ODKIT_BUS_PASSIVE, ODKIT_BUS_OFF};

		(void)odkit_handle_bus(node->node, odkit_zephyr_now(), states[state - 1]);
		if (state - 1 == CAN_STATE_BUS_OFF) {
			/* The controller dropped the frame that it had. */
			node->is_waiting = false;
			atomic_set(&node->is_sending, 0);
		}
	}
	if (atomic_clear(&node->has_lost) != 0) {
		(void)odkit_handle_bus(node->node, odkit_zephyr_now(), ODKIT_BUS_OVERRUN);
	}
	while (k_msgq_get(&node->received, &from, K_NO_WAIT) == 0) {
		odkit_frame frame = {.id = from.id, .len = from.dlc};

		/* A frame of CAN FD is not one of CANopen. */
		if ((from.flags & CAN_FRAME_FDF) != 0 || from.dlc > sizeof(frame.data)) {
			continue;
		}
		if ((from.flags & CAN_FRAME_IDE) != 0) {
			frame.flags |= ODKIT_EXTENDED;
		}
		if ((from.flags & CAN_FRAME_RTR) != 0) {
			frame.flags |= ODKIT_REMOTE;
		}
		memcpy(frame.data, from.data, from.dlc);
		(void)odkit_handle_frame(node->node, odkit_zephyr_now(), &frame);
	}
}

/* Gives the controller one frame at a time: of several with one identifier it may send the last one first, and segments of
 * one value must not overtake each other. */
static void send_frames(struct odkit_zephyr *node)
{
	while (atomic_get(&node->is_sending) == 0) {
		odkit_frame frame;
		int error;

		if (!node->is_waiting) {
			if (!odkit_poll_frame(node->node, &frame)) {
				return;
			}
			memset(&node->frame, 0, sizeof(node->frame));
			node->frame.id = frame.id;
			node->frame.dlc = frame.len;
			if ((frame.flags & ODKIT_EXTENDED) != 0) {
				node->frame.flags |= CAN_FRAME_IDE;
			}
			if ((frame.flags & ODKIT_REMOTE) != 0) {
				node->frame.flags |= CAN_FRAME_RTR;
			}
			memcpy(node->frame.data, frame.data, sizeof(frame.data));
		}
		/* The callback may come before can_send returns. */
		atomic_set(&node->is_sending, 1);
		error = can_send(node->can, &node->frame, K_NO_WAIT, on_sent, node);
		if (error != 0) {
			atomic_set(&node->is_sending, 0);
		}
		/* Others use the controller, too. */
		node->is_waiting = error == -EAGAIN;
		if (node->is_waiting) {
			return;
		}
	}
}

static void report(struct odkit_zephyr *node)
{
	odkit_event event;

	while (odkit_poll_event(node->node, &event)) {
		if (event.kind == ODKIT_EVENT_BIT_RATE) {
			(void)can_stop(node->can);
			node->is_waiting = false;
			atomic_set(&node->is_sending, 0);
			(void)start_can(node, event.value);
		}
		if (node->event != NULL) {
			node->event(node, &event);
		}
	}
}

uint32_t odkit_zephyr_step(struct odkit_zephyr *node)
{
	uint32_t wait;

	(void)k_mutex_lock(&node->mutex, K_FOREVER);
	receive_frames(node);
	if (odkit_poll_timeout(node->node, odkit_zephyr_now()) == 0) {
		(void)odkit_handle_timeout(node->node, odkit_zephyr_now());
	}
	send_frames(node);
	report(node);
	wait = odkit_poll_timeout(node->node, odkit_zephyr_now());
	(void)k_mutex_unlock(&node->mutex);
	if (node->is_waiting) {
		return AGAIN_US;
	}
	/* A PDO may be due that waits for the end of this frame, of which `on_sent` tells. */
	return atomic_get(&node->is_sending) != 0 && wait < AGAIN_US ? AGAIN_US : wait;
}

void odkit_zephyr_run(struct odkit_zephyr *node)
{
	for (;;) {
		uint32_t wait = odkit_zephyr_step(node);

		(void)k_sem_take(&node->wake, K_USEC(wait));
	}
}

void odkit_zephyr_lock(struct odkit_zephyr *node)
{
	(void)k_mutex_lock(&node->mutex, K_FOREVER);
}

void odkit_zephyr_unlock(struct odkit_zephyr *node)
{
	(void)k_mutex_unlock(&node->mutex);
	k_sem_give(&node->wake);
}
