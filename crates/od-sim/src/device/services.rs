//! The services that an EDS turns on, and those that it promises and a node does not have.

use std::prelude::v1::*;

use od_model::Dictionary;

/// Services of one EDS, in words.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Services {
    /// Services that the node of this EDS has.
    pub on: Vec<&'static str>,
    /// Services that the EDS promises, and the node does not have.
    pub missing: Vec<&'static str>,
}

/// Objects that turn a service on (CiA 301, chapter 7.5.2).
const ON: [(u16, u16, &str); 15] = [
    (0x1005, 0x1005, "SYNC consumer"),
    (0x1006, 0x1006, "SYNC producer"),
    (0x1012, 0x1012, "TIME"),
    (0x1010, 0x1010, "save (1010h)"),
    (0x1011, 0x1011, "restore defaults (1011h)"),
    (0x1014, 0x1014, "EMCY producer"),
    (0x1016, 0x1016, "heartbeat consumer"),
    (0x1017, 0x1017, "heartbeat producer"),
    (0x100C, 0x100D, "node guarding"),
    (0x1029, 0x1029, "error behaviour (1029h)"),
    (0x1201, 0x127F, "further SDO servers"),
    (0x1400, 0x15FF, "RPDOs"),
    (0x1800, 0x19FF, "TPDOs"),
    (0x1F51, 0x1F51, "program download"),
    (0x6004, 0x6004, "encoder (CiA 406)"),
];

/// Objects of services that a node does not have.
const MISSING: [(u16, u16, &str); 6] = [
    (0x1007, 0x1007, "synchronous window (1007h)"),
    (0x1013, 0x1013, "high resolution time stamp (1013h)"),
    (0x1280, 0x12FF, "SDO clients (1280h to 12FFh)"),
    (0x1F20, 0x1F2F, "configuration manager (1F20h to 1F2Fh)"),
    (0x1F81, 0x1F8F, "NMT master (1F81h to 1F8Fh)"),
    (0x1FA0, 0x1FCF, "multiplexed PDOs (1FA0h to 1FCFh)"),
];

/// Keys of [DeviceInfo] for services that a node does not have (CiA 306-1).
const KEYS: [(&str, &str); 3] = [
    ("SimpleBootUpMaster", "NMT master (`SimpleBootUpMaster=1`)"),
    ("GroupMessaging", "multiplexed PDOs (`GroupMessaging=1`)"),
    (
        "DynamicChannelsSupported",
        "dynamic channels (`DynamicChannelsSupported`)",
    ),
];

impl Services {
    /// Returns the services of a dictionary, of an LSS slave if there is one, and of the keys of
    /// [DeviceInfo] that are set.
    pub(crate) fn of(dictionary: Dictionary<'_>, lss: bool, key: impl Fn(&str) -> bool) -> Self {
        let has = |(from, to, _): &&(u16, u16, &str)| {
            let mut indices = dictionary.entries().iter().map(|entry| entry.address.index);
            indices.any(|index| (*from..=*to).contains(&index))
        };
        let name = |&(_, _, name): &(u16, u16, &'static str)| name;
        let lss = lss.then_some("LSS slave (CiA 305)");
        let keys = KEYS.iter().filter(|(name, _)| key(name));
        Self {
            on: ON.iter().filter(has).map(name).chain(lss).collect(),
            missing: (MISSING.iter().filter(has).map(name))
                .chain(keys.map(|(_, name)| *name))
                .collect(),
        }
    }
}
