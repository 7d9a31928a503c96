//! 11: targets of `odkit convert` that cannot express all of a description. A warning is what a
//! master sees of the target; of a remark it sees nothing. One rule per file.

catalogue! {
    w1101_no_storage W1101 (example)
    w1102_node_id_not_added W1102 (example)
    w1103_node_id_added W1103 (example)
    w1104_pdo_not_served W1104 (example)
    w1105_object_without_row W1105 (example)
    i1106_limits_not_checked I1106 (example)
    i1107_needed_object_missing I1107 (example)
    i1108_single_bits_on_request I1108 (example)
    w1109_cannot_start W1109 (example)
    w1110_multiplexed_pdo W1110 (example)
    w1111_no_room_in_message W1111 (example)
    w1112_not_a_number W1112 (example)
    w1113_same_can_id W1113 (example)
}

pub(crate) mod i1106_limits_not_checked;
pub(crate) mod i1107_needed_object_missing;
pub(crate) mod i1108_single_bits_on_request;
pub(crate) mod w1101_no_storage;
pub(crate) mod w1102_node_id_not_added;
pub(crate) mod w1103_node_id_added;
pub(crate) mod w1104_pdo_not_served;
pub(crate) mod w1105_object_without_row;
pub(crate) mod w1109_cannot_start;
pub(crate) mod w1110_multiplexed_pdo;
pub(crate) mod w1111_no_room_in_message;
pub(crate) mod w1112_not_a_number;
pub(crate) mod w1113_same_can_id;
