// Lely core with the objects of an EDS, behind slcan over TCP: `lely PORT NODE EDS`.

#include "slcan.h"

#include <lely/can/net.h>
#include <lely/co/dcf.h>
#include <lely/co/dev.h>
#include <lely/co/lss.h>
#include <lely/co/nmt.h>
#include <lely/co/obj.h>
#include <lely/co/sdo.h>
#include <lely/co/val.h>

static co_dev_t *device;

// Saved values as concise DCFs: communication (1000h), manufacturer (2000h) and application objects (6000h).
static const struct {
    co_unsigned16_t first, last;
    unsigned sub;
} areas[] = {{0x1000, 0x1FFF, 2}, {0x2000, 0x5FFF, 4}, {0x6000, 0x9FFF, 3}};
static void *saved[3];

static void forget(int area) {
    co_val_fini(CO_DEFTYPE_DOMAIN, &saved[area]);
    saved[area] = NULL;
}

// Writes to 1010h ("save") and 1011h ("load").
static co_unsigned32_t on_store(co_sub_t *sub, struct co_sdo_req *req, void *data) {
    co_unsigned32_t code = 0, value = 0;
    const bool is_save = data == NULL;
    if (co_sdo_req_dn_val(req, CO_DEFTYPE_UNSIGNED32, &value, &code) == -1) {
        return code;
    }
    if (value != (is_save ? 0x65766173 : 0x64616F6C)) {
        return CO_SDO_AC_DATA;
    }
    const unsigned which = co_sub_get_subidx(sub);
    for (int area = 0; area < 3; area++) {
        if (which == 1 || which == areas[area].sub) {
            forget(area);
            if (is_save && co_dev_write_dcf(device, areas[area].first, areas[area].last, &saved[area]) == -1) {
                return CO_SDO_AC_DATA;
            }
        }
    }
    return 0;
}

// A reset has loaded the values of the EDS; the saved ones replace them.
static void on_command(co_nmt_t *nmt, co_unsigned8_t command, void *data) {
    (void)nmt, (void)data;
    for (int area = 0; area < 3; area++) {
        const bool is_its = command == CO_NMT_CS_RESET_COMM ? area == 0 : command == CO_NMT_CS_RESET_NODE && area > 0;
        if (is_its && saved[area] != NULL) {
            co_dev_read_dcf(device, NULL, NULL, &saved[area]);
        }
    }
}

static void on_rate(co_lss_t *lss, co_unsigned16_t rate, int delay, void *data) {
    (void)lss, (void)rate, (void)delay, (void)data;
}

static int on_store_lss(co_lss_t *lss, co_unsigned8_t id, co_unsigned16_t rate, void *data) {
    (void)lss, (void)id, (void)rate, (void)data;
    return 0;
}

static int on_send(const struct can_msg *msg, void *data) {
    (void)data;
    struct slcan_frame frame = {.id = msg->id, .extended = (msg->flags & CAN_FLAG_IDE) != 0, .rtr = (msg->flags & CAN_FLAG_RTR) != 0, .len = msg->len};
    memcpy(frame.data, msg->data, 8);
    slcan_send(&frame);
    return 0;
}

static void tick(can_net_t *net) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    can_net_set_time(net, &now);
}

int main(int count, char **args) {
    if (count != 4) {
        return 2;
    }
    slcan_open(atoi(args[1]));
    can_net_t *net = can_net_create();
    tick(net);
    can_net_set_send_func(net, on_send, NULL);
    device = co_dev_create_from_dcf_file(args[3]);
    if (device == NULL || co_dev_set_id(device, (co_unsigned8_t)atoi(args[2])) == -1) {
        fprintf(stderr, "%s: not accepted\n", args[3]);
        return 1;
    }
    co_obj_t *save = co_dev_find_obj(device, 0x1010), *load = co_dev_find_obj(device, 0x1011);
    if (save != NULL) {
        co_obj_set_dn_ind(save, on_store, NULL);
    }
    if (load != NULL) {
        co_obj_set_dn_ind(load, on_store, &device);
    }
    co_nmt_t *nmt = co_nmt_create(net, device);
    co_nmt_set_cs_ind(nmt, on_command, NULL);
    co_lss_t *lss = co_nmt_get_lss(nmt);
    if (lss != NULL) {
        co_lss_set_rate_ind(lss, on_rate, NULL);
        co_lss_set_store_ind(lss, on_store_lss, NULL);
    }
    co_nmt_cs_ind(nmt, CO_NMT_CS_RESET_NODE);
    for (;;) {
        struct slcan_frame frame;
        const bool came = slcan_next(1, &frame);
        tick(net);
        if (came) {
            struct can_msg msg = CAN_MSG_INIT;
            msg.id = frame.id;
            msg.flags = (frame.rtr ? CAN_FLAG_RTR : 0) | (frame.extended ? CAN_FLAG_IDE : 0);
            msg.len = frame.len;
            memcpy(msg.data, frame.data, 8);
            can_net_recv(net, &msg);
        }
    }
}
