/* The public types of CANopenNode's object dictionary, as far as an OD.c has them: their names,
 * fields and values. What a test prints of it is in print.c. */
#include <stddef.h>
#include <stdint.h>

#define CO_VERSION_MAJOR 4
#define CO_PROGMEM const

typedef uint_fast8_t bool_t;
typedef float float32_t;
typedef double float64_t;
#define true 1
#define false 0

enum { ODA_SDO_R = 1, ODA_SDO_W = 2, ODA_SDO_RW = 3, ODA_TPDO = 4, ODA_RPDO = 8, ODA_TRPDO = 12, ODA_MB = 64, ODA_STR = 128 };
enum { ODT_VAR = 1, ODT_ARR = 2, ODT_REC = 3 };

typedef struct OD_extension OD_extension_t;

typedef struct {
    uint16_t index;
    uint8_t subEntriesCount, odObjectType;
    CO_PROGMEM void *odObject;
    OD_extension_t *extension;
} OD_entry_t;

typedef struct {
    uint16_t size;
    OD_entry_t *list;
} OD_t;

typedef struct {
    void *dataOrig;
    uint8_t attribute;
    uint32_t dataLength;
} OD_obj_var_t;

typedef struct {
    uint8_t *dataOrig0;
    void *dataOrig;
    uint8_t attribute0, attribute;
    uint32_t dataElementLength, dataElementSizeof;
} OD_obj_array_t;

typedef struct {
    void *dataOrig;
    uint8_t subIndex, attribute;
    uint32_t dataLength;
} OD_obj_record_t;
