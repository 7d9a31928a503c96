//! The rules, one file each. A rule explains the signs of the rules after it in the list.

mod bus_load;
mod bus_off;
mod consumer_too_tight;
mod emcy;
mod error_frames;
mod guarding;
mod heartbeat_flood;
mod heartbeat_lost;
mod inhibit_time;
mod mapping_differs;
mod nmt_not_followed;
mod pdo_lost;
mod reboots;
mod same_node_id;
mod sdo_broken;
mod sdo_echo;
mod sdo_refused;
mod sdo_timeout;
mod starts_late;
mod state_changed;
mod sync_irregular;
mod two_clients;
mod two_sync_producers;
mod unasked_responses;

use super::rule::Rule;

/// The rules about the line, whatever its frames mean.
pub(super) const OF_LINE: [&str; 2] = [error_frames::RULE.name, bus_load::RULE.name];

/// All rules. The first ones explain most: a bus without terminators loses heartbeats, PDOs and
/// responses.
pub(super) const ALL: &[Rule] = &[
    error_frames::RULE,
    sdo_echo::RULE,
    same_node_id::RULE,
    heartbeat_flood::RULE,
    bus_load::RULE,
    starts_late::RULE,
    bus_off::RULE,
    reboots::RULE,
    heartbeat_lost::RULE,
    guarding::RULE,
    two_sync_producers::RULE,
    sync_irregular::RULE,
    consumer_too_tight::RULE,
    mapping_differs::RULE,
    inhibit_time::RULE,
    pdo_lost::RULE,
    two_clients::RULE,
    unasked_responses::RULE,
    sdo_broken::RULE,
    sdo_timeout::RULE,
    sdo_refused::RULE,
    state_changed::RULE,
    nmt_not_followed::RULE,
    emcy::RULE,
];
