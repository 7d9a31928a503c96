//! 12: nodes of a network that do not fit together. One rule per file.

catalogue! {
    e1201_same_node_id E1201 (example)
    e1202_same_can_id E1202 (example)
    w1203_no_producer W1203 (example)
    e1204_consumer_time_too_short E1204 (example)
    w1205_bus_load W1205 (example)
    w1206_pdo_too_short W1206 (example)
}

pub(crate) mod e1201_same_node_id;
pub(crate) mod e1202_same_can_id;
pub(crate) mod e1204_consumer_time_too_short;
pub(crate) mod w1203_no_producer;
pub(crate) mod w1205_bus_load;
pub(crate) mod w1206_pdo_too_short;
