//! Devices with some services, whose dictionary is known at run time.
#![allow(unreachable_pub)]

use crate::support::Loaded;
use od_eds::Tables;
use od_model::Dictionary;
use od_runtime::rooms::{LoadedRooms, LoadedValues};
use od_runtime::{Device, Profile, Services};

/// Bits for the services of [`With`].
pub mod on {
    pub const LSS: u16 = 1 << 0;
    pub const SEGMENTED: u16 = 1 << 1;
    pub const BLOCK: u16 = 1 << 2;
    pub const RPDOS: u16 = 1 << 3;
    pub const GUARDING: u16 = 1 << 4;
    pub const CONSUMER: u16 = 1 << 5;
    pub const STORAGE: u16 = 1 << 6;
    pub const BEHAVIOUR: u16 = 1 << 7;
    pub const EVENTS: u16 = 1 << 8;
    pub const SERVERS: u16 = 1 << 9;
    pub const STREAMS: u16 = 1 << 10;
    /// Room for 20 errors, otherwise for 5.
    pub const ERRORS: u16 = 1 << 11;
    pub const CHANGES: u16 = 1 << 12;
    pub const TIME: u16 = 1 << 13;
    pub const SYNC_PRODUCER: u16 = 1 << 14;
}

/// A device with only these services.
pub struct With<const SERVICES: u16> {
    pub tables: Tables,
    pub profile: Profile,
}

impl<const SERVICES: u16> Loaded for With<SERVICES> {
    fn of(tables: Tables) -> Self {
        let profile = Profile::CIA301;
        Self { tables, profile }
    }
}

impl<const SERVICES: u16> Services for With<SERVICES> {
    const LSS: bool = SERVICES & on::LSS != 0;
    const SEGMENTED: bool = SERVICES & on::SEGMENTED != 0;
    const BLOCK: bool = SERVICES & on::BLOCK != 0;
    const RPDOS: bool = SERVICES & on::RPDOS != 0;
    const GUARDING: bool = SERVICES & on::GUARDING != 0;
    const CONSUMER: bool = SERVICES & on::CONSUMER != 0;
    const STORAGE: bool = SERVICES & on::STORAGE != 0;
    const BEHAVIOUR: bool = SERVICES & on::BEHAVIOUR != 0;
    const EVENTS: bool = SERVICES & on::EVENTS != 0;
    const SERVERS: bool = SERVICES & on::SERVERS != 0;
    const CHANGES: bool = SERVICES & on::CHANGES != 0;
    const TIME: bool = SERVICES & on::TIME != 0;
    const SYNC_PRODUCER: bool = SERVICES & on::SYNC_PRODUCER != 0;
    const STREAMS: bool = SERVICES & on::STREAMS != 0;
    const ERRORS: usize = if SERVICES & on::ERRORS != 0 { 20 } else { 5 };
}

impl<const SERVICES: u16> Device for With<SERVICES> {
    type Values = LoadedValues;
    type Rooms = LoadedRooms;

    fn dictionary(&self) -> Dictionary<'_> {
        self.tables.dictionary()
    }

    fn profile(&self) -> &Profile {
        &self.profile
    }
}
