//! Rules whose codes begin with 05: PDOs.

mod cob_ids;
pub(crate) mod shared;

catalogue! {
    e0501_mapped_object_missing E0501
    e0502_not_mappable E0502
    e0503_wrong_direction E0503
    e0504_wrong_length E0504
    e0505_pdo_too_long E0505
    w0506_dummy_not_allowed W0506
    e0507_tpdo_maps_dummy E0507
    w0508_pdo_incomplete W0508
    e0509_communication_parameter_incomplete E0509
    e0510_entry_not_unsigned32 E0510
    w0511_transmission_type_reserved W0511
    e0512_mapped_sub_index_missing E0512
    w0513_boolean_with_8_bits W0513
    i0515_compact_pdo I0515
    w0520_can_id_reserved W0520
    w0521_same_cob_id W0521
    w0522_can_id_too_long W0522
    w0524_too_many_entries W0524
    w0525_entry_0 W0525
    w0526_granularity W0526
    i0528_mapped_twice I0528
    w0529_sync_missing W0529
    w0530_default_sdo_without_node_id W0530
    i0531_cob_id_without_node_id I0531
    e0532_same_can_id E0532
    e0533_default_sdo_cob_id E0533
    w0534_rtr_not_allowed W0534
    w0535_inhibit_above_event_timer W0535
    w0536_sync_start_without_counter W0536
    e0537_mpdo_synchronous E0537
    w0538_sdo_client_other_server W0538
    w0539_limit_without_flag_bits W0539
    w0540_sdo_with_one_cob_id W0540
    e0541_mpdo_objects E0541
    w0542_cob_id_of_other_node W0542
}

pub(crate) mod e0501_mapped_object_missing;
pub(crate) mod e0502_not_mappable;
pub(crate) mod e0503_wrong_direction;
pub(crate) mod e0504_wrong_length;
pub(crate) mod e0505_pdo_too_long;
pub(crate) mod e0507_tpdo_maps_dummy;
pub(crate) mod e0509_communication_parameter_incomplete;
pub(crate) mod e0510_entry_not_unsigned32;
pub(crate) mod e0512_mapped_sub_index_missing;
pub(crate) mod e0532_same_can_id;
pub(crate) mod e0533_default_sdo_cob_id;
pub(crate) mod e0537_mpdo_synchronous;
pub(crate) mod e0541_mpdo_objects;
pub(crate) mod i0515_compact_pdo;
pub(crate) mod i0528_mapped_twice;
pub(crate) mod i0531_cob_id_without_node_id;
pub(crate) mod w0506_dummy_not_allowed;
pub(crate) mod w0508_pdo_incomplete;
pub(crate) mod w0511_transmission_type_reserved;
pub(crate) mod w0513_boolean_with_8_bits;
pub(crate) mod w0520_can_id_reserved;
pub(crate) mod w0521_same_cob_id;
pub(crate) mod w0522_can_id_too_long;
pub(crate) mod w0524_too_many_entries;
pub(crate) mod w0525_entry_0;
pub(crate) mod w0526_granularity;
pub(crate) mod w0529_sync_missing;
pub(crate) mod w0530_default_sdo_without_node_id;
pub(crate) mod w0534_rtr_not_allowed;
pub(crate) mod w0535_inhibit_above_event_timer;
pub(crate) mod w0536_sync_start_without_counter;
pub(crate) mod w0538_sdo_client_other_server;
pub(crate) mod w0539_limit_without_flag_bits;
pub(crate) mod w0540_sdo_with_one_cob_id;
pub(crate) mod w0542_cob_id_of_other_node;
