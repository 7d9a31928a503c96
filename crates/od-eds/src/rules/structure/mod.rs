//! 03: what an object consists of. One file per rule.

mod shared;

catalogue! {
    e0301_object_code_unknown E0301
    w0302_object_type_missing W0302
    e0303_duplicate_object_differs E0303
    w0304_duplicate_object W0304
    e0305_var_with_sub_objects E0305
    w0306_no_sub_objects W0306
    w0307_no_sub_index_0 W0307
    w0308_sub_number_count W0308
    e0309_sub_index_0_type E0309
    e0310_mapping_count E0310
    w0311_sub_index_0_too_low W0311
    w0312_array_types_differ W0312
    w0313_compact_not_valid W0313
    w0314_compact_sub_index_missing W0314
    w0315_name_missing W0315
    w0316_sub_number_not_a_number W0316
    w0317_sub_number_missing W0317
    w0318_key_misspelled W0318
    i0319_unknown_key I0319
    i0320_empty_value I0320
    w0321_nr_of_entries W0321
    w0322_sub_index_not_var W0322
    w0323_module_count W0323
    w0324_compact_beside_sections W0324
    w0325_value_of_array W0325
    w0342_obj_flags_reserved W0342
    w0343_index_reserved W0343
    w0344_name_too_long W0344
    i0345_same_sub_object_name I0345
    i0346_same_object_name I0346
    w0347_sub_index_0_writable W0347
    w0350_sub_index_0_too_high W0350
    w0351_array_gap W0351
    w0352_sub_number_of_var W0352
    e0353_too_many_sub_objects E0353 (example)
}

pub(crate) mod e0301_object_code_unknown;
pub(crate) mod e0303_duplicate_object_differs;
pub(crate) mod e0305_var_with_sub_objects;
pub(crate) mod e0309_sub_index_0_type;
pub(crate) mod e0310_mapping_count;
pub(crate) mod e0353_too_many_sub_objects;
pub(crate) mod i0319_unknown_key;
pub(crate) mod i0320_empty_value;
pub(crate) mod i0345_same_sub_object_name;
pub(crate) mod i0346_same_object_name;
pub(crate) mod w0302_object_type_missing;
pub(crate) mod w0304_duplicate_object;
pub(crate) mod w0306_no_sub_objects;
pub(crate) mod w0307_no_sub_index_0;
pub(crate) mod w0308_sub_number_count;
pub(crate) mod w0311_sub_index_0_too_low;
pub(crate) mod w0312_array_types_differ;
pub(crate) mod w0313_compact_not_valid;
pub(crate) mod w0314_compact_sub_index_missing;
pub(crate) mod w0315_name_missing;
pub(crate) mod w0316_sub_number_not_a_number;
pub(crate) mod w0317_sub_number_missing;
pub(crate) mod w0318_key_misspelled;
pub(crate) mod w0321_nr_of_entries;
pub(crate) mod w0322_sub_index_not_var;
pub(crate) mod w0323_module_count;
pub(crate) mod w0324_compact_beside_sections;
pub(crate) mod w0325_value_of_array;
pub(crate) mod w0342_obj_flags_reserved;
pub(crate) mod w0343_index_reserved;
pub(crate) mod w0344_name_too_long;
pub(crate) mod w0347_sub_index_0_writable;
pub(crate) mod w0350_sub_index_0_too_high;
pub(crate) mod w0351_array_gap;
pub(crate) mod w0352_sub_number_of_var;
