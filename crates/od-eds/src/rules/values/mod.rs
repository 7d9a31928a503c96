//! Rules whose codes begin with 04: types, values, limits.

pub(crate) mod shared;

catalogue! {
    e0401_data_type_missing E0401
    reader E0402
    e0403_record_type E0403
    reader W0404
    reader E0405
    reader W0406
    reader W0407
    spelling I0408
    spelling W0409
    spelling I0410
    spelling I0411
    not_valid E0412
    not_valid E0413
    limits E0414
    limits E0415
    not_valid W0416
    e0417_node_id_not_supported E0417
    e0418_node_id_formula_too_large E0418
    spelling W0419
    spelling W0420
    spelling W0421
    spelling W0422
    spelling W0423
    spelling W0424
    reader I0425
    reader W0426
    w0427_domain_with_number_type W0427
    reader E0428
    reader E0429 (xdd)
    reader W0430 (xdd)
    w0445_access_without_mapping W0445
    w0446_text_not_ascii W0446
    i0447_no_pdo_direction I0447
    limits I0450
    limits W0452
    w0453_constant_without_value W0453
    w0454_mappable_without_length W0454
    w0455_constant_changed W0455
    reader W0456
}

pub(crate) mod e0401_data_type_missing;
pub(crate) mod e0403_record_type;
pub(crate) mod e0417_node_id_not_supported;
pub(crate) mod e0418_node_id_formula_too_large;
pub(crate) mod i0447_no_pdo_direction;
pub(crate) mod limits;
pub(crate) mod not_valid;
pub(crate) mod reader;
pub(crate) mod spelling;
pub(crate) mod w0427_domain_with_number_type;
pub(crate) mod w0445_access_without_mapping;
pub(crate) mod w0446_text_not_ascii;
pub(crate) mod w0453_constant_without_value;
pub(crate) mod w0454_mappable_without_length;
pub(crate) mod w0455_constant_changed;
