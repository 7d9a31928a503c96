// What CANopenNode asks of its target: this computer, with the bus of slcan.h.

#ifndef CO_DRIVER_TARGET_H
#define CO_DRIVER_TARGET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CO_LITTLE_ENDIAN
#define CO_SWAP_16(x) x
#define CO_SWAP_32(x) x
#define CO_SWAP_64(x) x
typedef uint_fast8_t bool_t;
typedef float float32_t;
typedef double float64_t;

// Block transfer, and the services of the demo device.
#define CO_CONFIG_CRC16 CO_CONFIG_CRC16_ENABLE
#define CO_CONFIG_SDO_SRV (CO_CONFIG_SDO_SRV_SEGMENTED | CO_CONFIG_SDO_SRV_BLOCK | CO_CONFIG_FLAG_OD_DYNAMIC)
#define CO_CONFIG_SDO_SRV_BUFFER_SIZE 900
#define CO_CONFIG_EM                                                                                    \
    (CO_CONFIG_EM_PRODUCER | CO_CONFIG_EM_PROD_CONFIGURABLE | CO_CONFIG_EM_PROD_INHIBIT                 \
     | CO_CONFIG_EM_HISTORY | CO_CONFIG_EM_STATUS_BITS | CO_CONFIG_FLAG_OD_DYNAMIC)
#define CO_CONFIG_LSS (CO_CONFIG_LSS_SLAVE | CO_CONFIG_LSS_SLAVE_FASTSCAN_DIRECT_RESPOND)

// A received frame.
typedef struct {
    uint16_t ident;
    uint8_t DLC;
    uint8_t data[8];
} CO_CANrxMsg_t;

#define CO_CANrxMsg_readIdent(msg) (((CO_CANrxMsg_t *)(msg))->ident)
#define CO_CANrxMsg_readDLC(msg) (((CO_CANrxMsg_t *)(msg))->DLC)
#define CO_CANrxMsg_readData(msg) ((const uint8_t *)((CO_CANrxMsg_t *)(msg))->data)

typedef struct {
    uint16_t ident;
    uint16_t mask;
    void *object;
    void (*CANrx_callback)(void *object, void *message);
} CO_CANrx_t;

typedef struct {
    uint16_t ident;
    bool_t rtr;
    uint8_t DLC;
    uint8_t data[8];
    volatile bool_t bufferFull;
    volatile bool_t syncFlag;
} CO_CANtx_t;

typedef struct {
    void *CANptr;
    CO_CANrx_t *rxArray;
    uint16_t rxSize;
    CO_CANtx_t *txArray;
    uint16_t txSize;
    uint16_t CANerrorStatus;
    volatile bool_t CANnormal;
    volatile bool_t firstCANtxMessage;
} CO_CANmodule_t;

// Values that are saved, and the copy that a reset loads.
typedef struct {
    void *addr;
    size_t len;
    uint8_t subIndexOD;
    uint8_t attr;
    const void *defaults;
    uint8_t saved[2048];
    bool_t isSaved;
} CO_storage_entry_t;

// One thread: nothing is locked.
#define CO_LOCK_CAN_SEND(module) ((void)(module))
#define CO_UNLOCK_CAN_SEND(module) ((void)(module))
#define CO_LOCK_EMCY(module) ((void)(module))
#define CO_UNLOCK_EMCY(module) ((void)(module))
#define CO_LOCK_OD(module) ((void)(module))
#define CO_UNLOCK_OD(module) ((void)(module))
#define CO_MemoryBarrier()
#define CO_FLAG_READ(flag) ((flag) != NULL)
#define CO_FLAG_SET(flag) ((flag) = (void *)1L)
#define CO_FLAG_CLEAR(flag) ((flag) = NULL)

#endif
