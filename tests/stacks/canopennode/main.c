// CANopenNode with the objects of its demo device, behind slcan over TCP: `canopennode PORT NODE`.

#include "../slcan.h"

#include "CANopen.h"
#include "CO_identificators.h"
#include "OD.h"
#include "domainDemo.h"
#include "objectAccessOD.h"
#include "storage/CO_storage.h"

// Frames of the slave are sent at once; the buffers are never full.
void CO_CANsetConfigurationMode(void *CANptr) { (void)CANptr; }
void CO_CANsetNormalMode(CO_CANmodule_t *module) { module->CANnormal = true; }
void CO_CANmodule_disable(CO_CANmodule_t *module) { module->CANnormal = false; }
void CO_CANclearPendingSyncPDOs(CO_CANmodule_t *module) { (void)module; }
void CO_CANmodule_process(CO_CANmodule_t *module) { (void)module; }

CO_ReturnError_t CO_CANmodule_init(CO_CANmodule_t *module, void *CANptr, CO_CANrx_t rx[], uint16_t rx_count,
                                   CO_CANtx_t tx[], uint16_t tx_count, uint16_t rate) {
    (void)rate;
    *module = (CO_CANmodule_t){.CANptr = CANptr, .rxArray = rx, .rxSize = rx_count, .txArray = tx, .txSize = tx_count};
    module->firstCANtxMessage = true;
    for (int at = 0; at < rx_count; at++) {
        rx[at] = (CO_CANrx_t){.mask = 0xFFFF};
    }
    memset(tx, 0, tx_count * sizeof *tx);
    return CO_ERROR_NO;
}

// Bit 11 of an identifier says that the frame is remote.
CO_ReturnError_t CO_CANrxBufferInit(CO_CANmodule_t *module, uint16_t index, uint16_t ident, uint16_t mask, bool_t rtr,
                                    void *object, void (*callback)(void *object, void *message)) {
    if (module == NULL || object == NULL || callback == NULL || index >= module->rxSize) {
        return CO_ERROR_ILLEGAL_ARGUMENT;
    }
    uint16_t remote = rtr ? 0x800 : 0;
    module->rxArray[index] = (CO_CANrx_t){(ident & 0x7FF) | remote, (mask & 0x7FF) | 0x800, object, callback};
    return CO_ERROR_NO;
}

CO_CANtx_t *CO_CANtxBufferInit(CO_CANmodule_t *module, uint16_t index, uint16_t ident, bool_t rtr, uint8_t len,
                               bool_t sync) {
    if (module == NULL || index >= module->txSize) {
        return NULL;
    }
    CO_CANtx_t *buffer = &module->txArray[index];
    *buffer = (CO_CANtx_t){.ident = ident & 0x7FF, .rtr = rtr, .DLC = len, .syncFlag = sync};
    return buffer;
}

CO_ReturnError_t CO_CANsend(CO_CANmodule_t *module, CO_CANtx_t *buffer) {
    struct slcan_frame frame = {.id = buffer->ident, .rtr = buffer->rtr, .len = buffer->DLC};
    memcpy(frame.data, buffer->data, 8);
    slcan_send(&frame);
    module->firstCANtxMessage = false;
    return CO_ERROR_NO;
}

static void receive(CO_CANmodule_t *module, const struct slcan_frame *frame) {
    CO_CANrxMsg_t message = {.ident = (uint16_t)frame->id, .DLC = frame->len};
    memcpy(message.data, frame->data, 8);
    if (frame->extended) {
        return;
    }
    uint16_t ident = (uint16_t)frame->id | (frame->rtr ? 0x800 : 0);
    for (int at = 0; at < module->rxSize; at++) {
        CO_CANrx_t *buffer = &module->rxArray[at];
        if (((ident ^ buffer->ident) & buffer->mask) == 0 && buffer->CANrx_callback != NULL) {
            buffer->CANrx_callback(buffer->object, &message);
            return;
        }
    }
}

// 1010h and 1011h save to this process's memory, which a reset does not clear.
static ODR_t save(CO_storage_entry_t *entry, CO_CANmodule_t *module) {
    (void)module;
    memcpy(entry->saved, entry->addr, entry->len);
    entry->isSaved = true;
    return ODR_OK;
}

static ODR_t forget(CO_storage_entry_t *entry, CO_CANmodule_t *module) {
    (void)module;
    entry->isSaved = false;
    return ODR_OK;
}

static OD_PERSIST_COMM_t comm;
static OD_PERSIST_APP_t app;
static OD_RAM_t ram;
static CO_storage_t storage;
static CO_storage_entry_t entries[] = {
    {.addr = &OD_PERSIST_COMM, .len = sizeof comm, .subIndexOD = 2, .attr = CO_storage_cmd | CO_storage_restore},
    {.addr = &OD_PERSIST_APP, .len = sizeof app, .subIndexOD = 5, .attr = CO_storage_cmd | CO_storage_restore},
};

static void load(CO_storage_entry_t *entry) {
    memcpy(entry->addr, entry->isSaved ? entry->saved : entry->defaults, entry->len);
}

// The node ID and the bit rate of LSS: pending, and saved.
static uint8_t pending_id, saved_id;
static uint16_t pending_rate = 125, saved_rate = 125;

static bool_t has_rate(void *object, uint16_t rate) {
    (void)object;
    return rate == 125 || rate == 250 || rate == 500 || rate == 1000;
}

static bool_t save_lss(void *object, uint8_t id, uint16_t rate) {
    (void)object;
    saved_id = id;
    saved_rate = rate;
    return true;
}

static void check(CO_ReturnError_t error, const char *what, uint32_t info) {
    if (error != CO_ERROR_NO && error != CO_ERROR_NODE_ID_UNCONFIGURED_LSS) {
        fprintf(stderr, "%s: error %d (%Xh)\n", what, error, info);
        exit(1);
    }
}

// One communication reset: initialises the services, and runs them until the next reset.
static CO_NMT_reset_cmd_t run(CO_t *co) {
    uint32_t info = 0;
    co->CANmodule->CANnormal = false;
    check(CO_CANinit(co, NULL, pending_rate), "CAN", 0);
    OD_PERSIST_COMM_t *values = &OD_PERSIST_COMM;
    CO_LSS_address_t address = {.identity = {
        .vendorID = values->x1018_identity.vendor_ID,
        .productCode = values->x1018_identity.productCode,
        .revisionNumber = values->x1018_identity.revisionNumber,
        .serialNumber = values->x1018_identity.serialNumber,
    }};
    check(CO_LSSinit(co, &address, &pending_id, &pending_rate), "LSS", 0);
    CO_LSSslave_initCkBitRateCall(co->LSSslave, NULL, has_rate);
    CO_LSSslave_initCfgStoreCall(co->LSSslave, NULL, save_lss);
    uint8_t id = pending_id;
    uint16_t control = CO_ERR_REG_GENERIC_ERR | CO_ERR_REG_COMMUNICATION | CO_NMT_ERR_ON_ERR_REG;
    check(CO_CANopenInit(co, NULL, NULL, OD, OD_ENTRY_H2100_errorStatusBits, control, 0, 1000, 500, false, id, &info),
          "CANopen", info);
    check(CO_CANopenInitPDO(co, co->em, OD, id, &info), "PDO", info);
    CO_CANsetNormalMode(co->CANmodule);
    uint64_t last = slcan_now();
    for (;;) {
        struct slcan_frame frame;
        if (slcan_next(1, &frame)) {
            receive(co->CANmodule, &frame);
        }
        uint64_t now = slcan_now();
        uint32_t passed = (uint32_t)(now - last);
        last = now;
        CO_NMT_reset_cmd_t reset = CO_process(co, false, passed, NULL);
        if (reset != CO_RESET_NOT) {
            return reset;
        }
        if (!co->nodeIdUnconfigured) {
            bool_t sync = CO_process_SYNC(co, passed, NULL);
            CO_process_RPDO(co, sync, passed, NULL);
            CO_process_TPDO(co, sync, passed, NULL);
        }
    }
}

int main(int count, char **args) {
    uint32_t size = 0, info = 0;
    if (count != 3) {
        return 2;
    }
    slcan_open(atoi(args[1]));
    saved_id = (uint8_t)atoi(args[2]);
    CO_identificators_init(&saved_rate, &saved_id);
    comm = OD_PERSIST_COMM;
    app = OD_PERSIST_APP;
    ram = OD_RAM;
    entries[0].defaults = &comm;
    entries[1].defaults = &app;
    CO_t *co = CO_new(NULL, &size);
    objectAccessOD_t record;
    CO_NMT_reset_cmd_t reset = CO_RESET_APP;
    for (;;) {
        if (reset != CO_RESET_COMM) {
            OD_RAM = ram;
            load(&entries[1]);
            pending_id = saved_id;
            pending_rate = saved_rate;
            check(objectAccessOD_init(&record, OD_ENTRY_H2120_demoRecord, &info), "2120h", info);
            check(domainDemo_init(OD_ENTRY_H2122_demoDomain, &info), "2122h", info);
        }
        load(&entries[0]);
        check(CO_storage_init(&storage, co->CANmodule, OD_ENTRY_H1010_storeParameters,
                              OD_ENTRY_H1011_restoreDefaultParameters, save, forget, entries, 2),
              "storage", 0);
        storage.enabled = true;
        reset = run(co);
    }
}
