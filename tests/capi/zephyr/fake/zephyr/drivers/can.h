/* The part of Zephyr's interface of CAN controllers that the module of odkit uses. */
#ifndef FAKE_CAN_H
#define FAKE_CAN_H

#include <zephyr/kernel.h>

#define CAN_FRAME_IDE BIT(0)
#define CAN_FRAME_RTR BIT(1)
#define CAN_FRAME_FDF BIT(2)

enum can_state {
    CAN_STATE_ERROR_ACTIVE,
    CAN_STATE_ERROR_WARNING,
    CAN_STATE_ERROR_PASSIVE,
    CAN_STATE_BUS_OFF,
    CAN_STATE_STOPPED
};

struct can_frame {
    uint32_t id;
    uint8_t dlc;
    uint8_t flags;
    uint16_t reserved;
    uint8_t data[8];
};

struct can_filter {
    uint32_t id;
    uint32_t mask;
    uint8_t flags;
};

struct can_bus_err_cnt {
    uint8_t tx_err_cnt;
    uint8_t rx_err_cnt;
};

typedef void (*can_tx_callback_t)(const struct device *can, int error, void *user);
typedef void (*can_rx_callback_t)(const struct device *can, struct can_frame *frame, void *user);
typedef void (*can_state_change_callback_t)(const struct device *can, enum can_state state,
                                            struct can_bus_err_cnt errors, void *user);

int can_start(const struct device *can);
int can_stop(const struct device *can);
int can_set_bitrate(const struct device *can, uint32_t bitrate);
int can_send(const struct device *can, const struct can_frame *frame, k_timeout_t timeout,
             can_tx_callback_t callback, void *user);
int can_add_rx_filter(const struct device *can, can_rx_callback_t callback, void *user,
                      const struct can_filter *filter);
void can_set_state_change_callback(const struct device *can, can_state_change_callback_t callback,
                                   void *user);

#endif
