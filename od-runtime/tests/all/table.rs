//! Devices whose services and dictionary the compiler knows.
#![allow(unreachable_pub)]

use core::marker::PhantomData;

use od_model::row::Row;
use od_model::{
    Access, Address, DataType, Dictionary, Entry, Group, Literal, Names, ObjectCode, Range, Slot,
};
use od_runtime::Device;

/// Bits of the services of [`With`].
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
    /// Room for 20 errors, else for 5.
    pub const ERRORS: u16 = 1 << 11;
    pub const CHANGES: u16 = 1 << 12;
    pub const TIME: u16 = 1 << 13;
    pub const SYNC_PRODUCER: u16 = 1 << 14;
}

/// The values of a device.
pub trait Table {
    /// `None`: they are known at run time.
    const ROWS: Option<&'static [Row]>;
}

/// Values that are known at run time.
pub struct Unknown;

impl Table for Unknown {
    const ROWS: Option<&'static [Row]> = None;
}

/// A device with these values, and with only these services.
pub struct With<T, const SERVICES: u16>(PhantomData<T>);

impl<T: Table, const SERVICES: u16> Device for With<T, SERVICES> {
    const DICTIONARY: Option<Dictionary<'static>> = match T::ROWS {
        Some(rows) => Some(dictionary(rows)),
        None => None,
    };
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

/// A number of 32 bits at an address.
pub const fn row(index: u16, sub: u8) -> Row {
    let entry = Entry {
        address: Address::new(index, sub),
        data_type: DataType::Unsigned32,
        access: Access::Rw,
        mappable: false,
        group: Group::None,
        name: Range::new(0, 0),
        default: Literal::None,
        low: Literal::None,
        high: Literal::None,
        slot: Slot { offset: 0, len: 4 },
    };
    Row::new(&entry, ObjectCode::Record, 0, 0)
}

const fn dictionary(rows: &'static [Row]) -> Dictionary<'static> {
    let names = Names {
        rows: &[],
        text: "",
    };
    let buckets = od_model::owned::Buckets::Words(&[]);
    Dictionary::trusted(buckets, rows, &[], "", &[], 4, None, None, names)
}
