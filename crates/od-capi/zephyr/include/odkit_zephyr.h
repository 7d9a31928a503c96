/* Runs a node of odkit on a CAN controller of Zephyr.
 *
 *     static struct odkit_zephyr node = {
 *         .node = ODKIT_NODE,
 *         .can = DEVICE_DT_GET(DT_CHOSEN(zephyr_canbus)),
 *         .kbit = 500,
 *         .node_id = 5,
 *     };
 *
 *     if (odkit_zephyr_start(&node) == 0) {
 *         odkit_zephyr_run(&node);
 *     }
 */
#ifndef ODKIT_ZEPHYR_H
#define ODKIT_ZEPHYR_H

#include <zephyr/drivers/can.h>
#include <zephyr/kernel.h>

#include "odkit.h"

#ifdef CONFIG_ODKIT_STORAGE
#include <zephyr/storage/flash_map.h>
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* A node and its CAN controller. The members above the line are set by the application before odkit_zephyr_start, and stay
 * as they are; it has to start with zeros. */
struct odkit_zephyr {
	/* Handle of the node, from odkit_objects.h. */
	odkit_node node;
	const struct device *can;
	/* Bit rate in kbit/s. */
	uint32_t kbit;
	/* 1 to 127, or ODKIT_UNCONFIGURED for a device that waits for LSS. */
	uint8_t node_id;
	/* Callbacks. Their context is this structure, whatever `context` says. With `partition`, the storage is
	 * that of the partition. */
	odkit_device device;
	/* For the application. */
	void *user;
	/* Gets each event of the node, in the thread of odkit_zephyr_run; may be NULL. */
	void (*event)(struct odkit_zephyr *node, const odkit_event *event);
#ifdef CONFIG_ODKIT_STORAGE
	/* The flash partition for saved values has the number `partition`, as FIXED_PARTITION_ID returns it. */
	bool has_partition;
	uint8_t partition;
#endif

	/* ---- For odkit_zephyr.c. ---- */
#ifdef CONFIG_ODKIT_STORAGE
	const struct flash_area *area;
#endif
	struct k_mutex mutex;
	struct k_sem wake;
	struct k_msgq received;
	struct can_frame room[CONFIG_ODKIT_RX_QUEUE];
	/* The frame that the controller has, or that waits for it. */
	struct can_frame frame;
	bool is_waiting;
	atomic_t is_sending;
	/* State of the controller plus 1, if it changed. */
	atomic_t state;
	atomic_t has_lost;
};

/* Starts the CAN controller and switches the node on. Returns 0, or a negative number of errno.h: -EINVAL for a node ID, a
 * handle or a partition that is not valid, or an error of the controller. */
int odkit_zephyr_start(struct odkit_zephyr *node);

/* Runs the node in the calling thread: sleeps until a frame, a deadline, or a change. Does not return. */
void odkit_zephyr_run(struct odkit_zephyr *node);

/* Does once what is to be done now, and returns the microseconds until the next time, if nothing happens before. For an
 * application with a loop of its own; odkit_zephyr_run calls it. */
uint32_t odkit_zephyr_step(struct odkit_zephyr *node);

/* A thread that calls functions of odkit for this node locks it before. Callbacks need no lock. Unlock makes the node send
 * what the calls caused. */
void odkit_zephyr_lock(struct odkit_zephyr *node);
void odkit_zephyr_unlock(struct odkit_zephyr *node);

/* The time for functions of odkit. */
uint32_t odkit_zephyr_now(void);

#ifdef __cplusplus
}
#endif

#endif
