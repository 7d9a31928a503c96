/* Prints each value of OD.c as a node has it: address, attributes, length and bytes. */
#include <stdio.h>

#include "OD.c"

static void value(unsigned index, unsigned sub, unsigned attribute, const uint8_t *data, unsigned length)
{
    printf("%04X %02X %02X %u ", index, sub, attribute, length);
    for (unsigned i = 0; data != NULL && i < length; i++)
        printf("%02X", data[i]);
    printf(data == NULL ? "-\n" : "\n");
}

int main(void)
{
    for (unsigned i = 0; i < OD->size; i++) {
        const OD_entry_t *entry = &OD->list[i];
        const OD_obj_var_t *var = entry->odObject;
        const OD_obj_array_t *array = entry->odObject;
        const OD_obj_record_t *record = entry->odObject;
        for (unsigned sub = 0; sub < entry->subEntriesCount; sub++) {
            if (entry->odObjectType == ODT_VAR)
                value(entry->index, 0, var->attribute, var->dataOrig, var->dataLength);
            else if (entry->odObjectType == ODT_REC)
                value(entry->index, record[sub].subIndex, record[sub].attribute, record[sub].dataOrig,
                      record[sub].dataLength);
            else if (sub == 0)
                value(entry->index, 0, array->attribute0, array->dataOrig0, 1);
            else
                value(entry->index, sub, array->attribute,
                      (const uint8_t *)array->dataOrig + array->dataElementSizeof * (sub - 1),
                      array->dataElementLength);
        }
    }
    return 0;
}
