//! The keys of node lists (CiA 306-3) and of projects of dcfgen, each with its meaning.

/// Keys and their meanings.
pub type Keys = &'static [(&'static str, &'static str)];

/// The keys of a network in a node list.
pub const OF_LIST: Keys = &[
    ("NetName", "Name of the network."),
    ("NetRefd", "Reference to the network in a project."),
    ("Nodes", "Number of nodes that are present, such as `0x02`."),
    ("EDSBaseName", "Folder of the EDS files."),
];

/// The keys of a node in a node list, behind `Node` and its node ID: `Node5DCFName`.
pub const OF_LISTED: Keys = &[
    ("Present", "`0x01` if the node is present, `0x00` if not."),
    ("Name", "Name of the node."),
    ("Refd", "Reference to the node in a project."),
    ("DCFName", "File name of the DCF of the node."),
];

/// The keys of a slave in a project.
pub const OF_SLAVE: Keys = &[
    ("dcf", "File name of the EDS or DCF of the node."),
    (
        "dcf_path",
        "Folder in which the master finds the concise DCF of the node at run time.",
    ),
    ("node_id", "Node ID, 1 to 127."),
    (
        "revision_number",
        "Revision number (1018h:03) that the master expects; 0: it does not check the number.",
    ),
    (
        "serial_number",
        "Serial number (1018h:04) that the master expects; 0: it does not check the number.",
    ),
    ("time_cob_id", "COB-ID of TIME (1012h)."),
    (
        "heartbeat_multiplier",
        "Consumer heartbeat time divided by the producer heartbeat time.",
    ),
    (
        "heartbeat_consumer",
        "`true`: the node monitors the heartbeat of the master (1016h).",
    ),
    (
        "heartbeat_producer",
        "Producer heartbeat time in ms (1017h).",
    ),
    (
        "retry_factor",
        "Number of guarding requests without a response, after which the master reports an error.",
    ),
    ("guard_time", "Guard time in ms (100Ch)."),
    ("life_time_factor", "Life time factor (100Dh)."),
    (
        "error_behavior",
        "NMT state after an error (1029h), by sub-index: `{1: 0}`.",
    ),
    ("rpdo", "RPDOs of the node, by number."),
    ("tpdo", "TPDOs of the node, by number."),
    ("boot", "`true`: the master boots the node (1F81h)."),
    (
        "mandatory",
        "`true`: the network does not start without the node (1F81h).",
    ),
    (
        "reset_communication",
        "`true`: the master may reset the communication of the node at any time (1F81h).",
    ),
    (
        "software_file",
        "File name of the program of the node (1F58h).",
    ),
    (
        "software_version",
        "Version of the program that the master expects (1F55h).",
    ),
    (
        "restore_configuration",
        "Sub-index of 1011h that the master writes before it configures the node (1F8Ah).",
    ),
    (
        "sdo",
        "Further values that the master writes: `{index: 0x2000, sub_index: 0, value: 1}`.",
    ),
];

/// The keys of the master in a project.
pub const OF_MASTER: Keys = &[
    ("node_id", "Node ID of the master, 1 to 127."),
    ("baudrate", "Bit rate in kbit/s."),
    ("vendor_id", "Vendor-ID of the master (1018h:01)."),
    ("product_code", "Product code of the master (1018h:02)."),
    (
        "revision_number",
        "Revision number of the master (1018h:03).",
    ),
    ("serial_number", "Serial number of the master (1018h:04)."),
    (
        "sync_period",
        "Time between two SYNC messages in µs (1006h); 0: no SYNC.",
    ),
    ("sync_window", "Synchronous window length in µs (1007h)."),
    (
        "sync_overflow",
        "Highest value of the SYNC counter (1019h); 0: no counter.",
    ),
    ("time_cob_id", "COB-ID of TIME (1012h)."),
    (
        "emcy_inhibit_time",
        "Shortest time between two EMCY messages, in 100 µs (1015h).",
    ),
    (
        "heartbeat_multiplier",
        "Consumer heartbeat time divided by the producer heartbeat time.",
    ),
    (
        "heartbeat_consumer",
        "`true`: the master monitors the heartbeats of the nodes (1016h).",
    ),
    (
        "heartbeat_producer",
        "Producer heartbeat time of the master in ms (1017h).",
    ),
    (
        "error_behavior",
        "NMT state of the master after an error (1029h), by sub-index: `{1: 0}`.",
    ),
    (
        "nmt_inhibit_time",
        "Shortest time between two NMT messages, in 100 µs (102Ah).",
    ),
    ("start", "`true`: the master starts itself (1F80h, bit 2)."),
    (
        "start_nodes",
        "`true`: the master starts the nodes (1F80h, bit 3).",
    ),
    (
        "start_all_nodes",
        "`true`: the master starts all nodes with one message (1F80h, bit 1).",
    ),
    (
        "reset_all_nodes",
        "`true`: an error of a mandatory node resets all nodes (1F80h, bit 4).",
    ),
    (
        "stop_all_nodes",
        "`true`: an error of a mandatory node stops all nodes (1F80h, bit 6).",
    ),
    (
        "boot_time",
        "Time in ms that the master waits for the mandatory nodes (1F89h).",
    ),
];

/// The keys of `options` in a project.
pub const OF_OPTIONS: Keys = &[
    (
        "dcf_path",
        "Folder in which the master finds the concise DCFs of the nodes at run time.",
    ),
    (
        "heartbeat_multiplier",
        "Consumer heartbeat time divided by the producer heartbeat time.",
    ),
    (
        "retry_factor",
        "Number of guarding requests without a response, after which the master reports an error.",
    ),
];

/// The keys of a PDO in a project.
pub const OF_PDO: Keys = &[
    ("enabled", "`true`: the PDO is valid."),
    ("cob_id", "COB-ID, or `auto` for that of CiA 301."),
    ("transmission", "Transmission type, 0 to 255."),
    ("inhibit_time", "Inhibit time in 100 µs."),
    ("event_timer", "Event timer in ms."),
    (
        "event_deadline",
        "Time in ms within which the node expects the PDO.",
    ),
    (
        "sync_start",
        "SYNC counter at which the PDO begins, 0 to 240.",
    ),
    (
        "mapping",
        "Mapped objects: `{index: 0x6000, sub_index: 1}`.",
    ),
];

/// The names of some keys.
pub fn names(keys: Keys) -> impl Iterator<Item = &'static str> + Clone {
    keys.iter().map(|(name, _)| *name)
}
