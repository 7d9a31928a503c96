//! Rules whose codes begin with 03: the parts of an object.

mod shared;

catalogue! {
    reader E0301
    reader W0302
    reader E0303
    reader W0304
    reader E0305
    w0306_no_sub_objects W0306
    w0307_no_sub_index_0 W0307
    w0308_sub_number_count W0308
    e0309_sub_index_0_type E0309
    e0310_mapping_count E0310
    w0311_sub_index_0_too_low W0311
    w0312_array_types_differ W0312
    reader W0313
    reader W0314
    reader W0315
    reader W0316
    reader W0317
    reader W0318
    reader I0319
    reader I0320
    reader W0321
    reader W0322
    reader W0323
    reader W0324
    reader W0325
    reader W0342
    w0343_index_reserved W0343
    w0344_name_too_long W0344
    i0345_same_sub_object_name I0345
    i0346_same_object_name I0346
    w0347_sub_index_0_writable W0347
    w0350_sub_index_0_too_high W0350
    w0351_array_gap W0351
    w0352_sub_number_of_var W0352
    reader E0353 (example)
    w0354_type_definition W0354
}

pub(crate) mod e0309_sub_index_0_type;
pub(crate) mod e0310_mapping_count;
pub(crate) mod i0345_same_sub_object_name;
pub(crate) mod i0346_same_object_name;
pub(crate) mod reader;
pub(crate) mod w0306_no_sub_objects;
pub(crate) mod w0307_no_sub_index_0;
pub(crate) mod w0308_sub_number_count;
pub(crate) mod w0311_sub_index_0_too_low;
pub(crate) mod w0312_array_types_differ;
pub(crate) mod w0343_index_reserved;
pub(crate) mod w0344_name_too_long;
pub(crate) mod w0347_sub_index_0_writable;
pub(crate) mod w0350_sub_index_0_too_high;
pub(crate) mod w0351_array_gap;
pub(crate) mod w0352_sub_number_of_var;
pub(crate) mod w0354_type_definition;
