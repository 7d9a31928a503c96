//! 07: edits of a macro call or a variant. One file a rule.

catalogue! {
    e0701_object_missing E0701 (example)
    e0702_object_exists E0702 (example)
    e0703_sub_object_without_object E0703 (example)
    e0704_object_without_sub_objects E0704 (example)
    e0705_name_missing E0705 (example)
    e0706_type_missing E0706 (example)
    e0707_value_not_valid E0707 (example)
    e0708_value_of_base_not_valid E0708 (example)
    e0709_sub_object_with_object_code E0709 (example)
    e0710_value_of_object_with_sub_objects E0710 (example)
    e0711_field_not_for_type E0711 (example)
    e0712_index_of_data_types E0712 (example)
}

pub(crate) mod e0701_object_missing;
pub(crate) mod e0702_object_exists;
pub(crate) mod e0703_sub_object_without_object;
pub(crate) mod e0704_object_without_sub_objects;
pub(crate) mod e0705_name_missing;
pub(crate) mod e0706_type_missing;
pub(crate) mod e0707_value_not_valid;
pub(crate) mod e0708_value_of_base_not_valid;
pub(crate) mod e0709_sub_object_with_object_code;
pub(crate) mod e0710_value_of_object_with_sub_objects;
pub(crate) mod e0711_field_not_for_type;
pub(crate) mod e0712_index_of_data_types;
