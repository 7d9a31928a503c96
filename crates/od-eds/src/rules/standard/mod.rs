//! Rules whose codes begin with 06: mandatory and standard objects, identity, `[DeviceInfo]`.

mod shared;

catalogue! {
    mandatory E0601
    mandatory E0602
    mandatory E0603
    mandatory E0604
    mandatory E0605
    e0606_identity_differs E0606
    w0607_device_info_identity W0607
    w0608_device_info_pdo_count W0608
    reader W0609
    reader I0610
    reader I0611
    w0630_other_object_code W0630
    w0631_other_data_type W0631
    w0632_other_access W0632
    w0633_sub_object_missing W0633
    w0634_lss_address_incomplete W0634
    w0635_no_error_control W0635
    w0637_no_bit_rate W0637
    w0638_dcf_bit_rate W0638
    w0639_error_history_not_empty W0639
    w0642_needed_object_missing W0642
    e0643_access_missing E0643
    w0644_mappable W0644
    e0646_node_id_not_valid E0646
    w0647_reserved_index W0647
    w0648_reserved_value W0648
    w0649_sync_contradiction W0649
    heartbeat_consumers E0650
    heartbeat_consumers W0651
    heartbeat_consumers W0652
    w0653_commissioning_incomplete W0653
    w0655_error_register_not_0 W0655
    w0656_guarding_and_heartbeat W0656
    i0657_vendor_id_0 I0657
    reader W0658
    w0659_value_with_node_id W0659
    w0660_slave_bit_missing W0660
    w0661_group_messaging W0661
    w0662_slaves_without_master W0662
}

pub(crate) mod e0606_identity_differs;
pub(crate) mod e0643_access_missing;
pub(crate) mod e0646_node_id_not_valid;
pub(crate) mod heartbeat_consumers;
pub(crate) mod i0657_vendor_id_0;
pub(crate) mod mandatory;
pub(crate) mod reader;
pub(crate) mod w0607_device_info_identity;
pub(crate) mod w0608_device_info_pdo_count;
pub(crate) mod w0630_other_object_code;
pub(crate) mod w0631_other_data_type;
pub(crate) mod w0632_other_access;
pub(crate) mod w0633_sub_object_missing;
pub(crate) mod w0634_lss_address_incomplete;
pub(crate) mod w0635_no_error_control;
pub(crate) mod w0637_no_bit_rate;
pub(crate) mod w0638_dcf_bit_rate;
pub(crate) mod w0639_error_history_not_empty;
pub(crate) mod w0642_needed_object_missing;
pub(crate) mod w0644_mappable;
pub(crate) mod w0647_reserved_index;
pub(crate) mod w0648_reserved_value;
pub(crate) mod w0649_sync_contradiction;
pub(crate) mod w0653_commissioning_incomplete;
pub(crate) mod w0655_error_register_not_0;
pub(crate) mod w0656_guarding_and_heartbeat;
pub(crate) mod w0659_value_with_node_id;
pub(crate) mod w0660_slave_bit_missing;
pub(crate) mod w0661_group_messaging;
pub(crate) mod w0662_slaves_without_master;
