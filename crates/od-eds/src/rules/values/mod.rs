//! 04: types, values, limits. One file a rule.

pub(crate) mod shared;

catalogue! {
    e0401_data_type_missing E0401
    e0402_data_type_unknown E0402
    e0403_record_type E0403
    w0404_access_type_missing W0404
    e0405_access_type_not_valid E0405
    w0406_pdo_mapping_not_valid W0406
    w0407_obj_flags_not_a_number W0407
    i0408_octal I0408
    w0409_leading_0 W0409
    i0410_twos_complement I0410
    i0411_node_id_formula_spelling I0411
    e0412_default_not_valid E0412
    e0413_parameter_value_not_valid E0413
    e0414_parameter_value_outside_limits E0414
    e0415_limits_swapped E0415
    w0416_limit_not_valid W0416
    e0417_node_id_not_supported E0417
    e0418_node_id_formula_too_large E0418
    w0419_not_hexadecimal W0419
    w0420_suffix_or_point W0420
    w0421_boolean_not_valid W0421
    w0422_hexadecimal_without_0x W0422
    w0423_decimal_comma W0423
    w0424_word W0424
    i0425_own_data_type I0425
    w0426_standard_type_missing W0426
    w0427_domain_with_number_type W0427
    e0428_node_id_misspelled E0428
    e0429_access_of_parameter E0429 (xdd)
    w0445_access_without_mapping W0445
    w0446_text_not_ascii W0446
    i0447_no_pdo_direction I0447
    i0450_only_one_value I0450
    w0452_default_outside_limits W0452
    w0453_constant_without_value W0453
    w0454_mappable_without_length W0454
}

pub(crate) mod e0401_data_type_missing;
pub(crate) mod e0402_data_type_unknown;
pub(crate) mod e0403_record_type;
pub(crate) mod e0405_access_type_not_valid;
pub(crate) mod e0412_default_not_valid;
pub(crate) mod e0413_parameter_value_not_valid;
pub(crate) mod e0414_parameter_value_outside_limits;
pub(crate) mod e0415_limits_swapped;
pub(crate) mod e0417_node_id_not_supported;
pub(crate) mod e0418_node_id_formula_too_large;
pub(crate) mod e0428_node_id_misspelled;
pub(crate) mod e0429_access_of_parameter;
pub(crate) mod i0408_octal;
pub(crate) mod i0410_twos_complement;
pub(crate) mod i0411_node_id_formula_spelling;
pub(crate) mod i0425_own_data_type;
pub(crate) mod i0447_no_pdo_direction;
pub(crate) mod i0450_only_one_value;
pub(crate) mod w0404_access_type_missing;
pub(crate) mod w0406_pdo_mapping_not_valid;
pub(crate) mod w0407_obj_flags_not_a_number;
pub(crate) mod w0409_leading_0;
pub(crate) mod w0416_limit_not_valid;
pub(crate) mod w0419_not_hexadecimal;
pub(crate) mod w0420_suffix_or_point;
pub(crate) mod w0421_boolean_not_valid;
pub(crate) mod w0422_hexadecimal_without_0x;
pub(crate) mod w0423_decimal_comma;
pub(crate) mod w0424_word;
pub(crate) mod w0426_standard_type_missing;
pub(crate) mod w0427_domain_with_number_type;
pub(crate) mod w0445_access_without_mapping;
pub(crate) mod w0446_text_not_ascii;
pub(crate) mod w0452_default_outside_limits;
pub(crate) mod w0453_constant_without_value;
pub(crate) mod w0454_mappable_without_length;
