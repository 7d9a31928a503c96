//! Typed handles, which the macro makes for every entry.
//!
//! The type of a handle has the Rust type, the access and the PDO mapping flag of the
//! value, so that mistakes that an SDO abort would report at run time do not compile.

use core::marker::PhantomData;

use crate::address::Address;
use crate::entry::Slot;

mod sealed {
    pub trait Sealed {}
}

/// Type parameters of a handle, which is `Send` and `Sync` for all of them.
type Marker<T> = PhantomData<fn() -> T>;

/// A Rust type that an entry can have.
///
/// ```
/// use od_model::typed::Scalar;
///
/// assert_eq!(500_u16.to_wire()[..2], [0xF4, 0x01]);
/// assert_eq!(i16::from_wire(&[0xFF, 0xFF]), -1);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not the Rust type of any CANopen data type",
    note = "bool, u8–u64, i8–i64, f32 and f64 are; strings go through `Text`"
)]
pub trait Scalar: Copy + sealed::Sealed {
    /// The value of little-endian `bytes`. Missing bytes are 0, or copies of the sign for signed
    /// types.
    fn from_wire(bytes: &[u8]) -> Self;
    /// The value's eight low bytes, little-endian, sign extended.
    fn to_wire(self) -> [u8; 8];
}

macro_rules! integers {
    ($($t:ty => $wide:ty),*) => {$(
        impl sealed::Sealed for $t {}
        impl Scalar for $t {
            fn from_wire(bytes: &[u8]) -> Self {
                let negative = <$t>::MIN != 0 && bytes.last().is_some_and(|b| b & 0x80 != 0);
                let mut wide = [if negative { 0xFF } else { 0 }; 8];
                for (to, from) in wide.iter_mut().zip(bytes) {
                    *to = *from;
                }
                <$wide>::from_le_bytes(wide) as $t
            }
            fn to_wire(self) -> [u8; 8] {
                (self as $wide).to_le_bytes()
            }
        }
    )*};
}
integers!(u8 => u64, u16 => u64, u32 => u64, u64 => u64, i8 => i64, i16 => i64, i32 => i64, i64 => i64);

impl sealed::Sealed for bool {}
impl Scalar for bool {
    fn from_wire(bytes: &[u8]) -> Self {
        bytes.first().is_some_and(|b| *b != 0)
    }
    fn to_wire(self) -> [u8; 8] {
        u64::from(self).to_le_bytes()
    }
}

impl sealed::Sealed for f32 {}
impl Scalar for f32 {
    fn from_wire(bytes: &[u8]) -> Self {
        f32::from_bits(u32::from_wire(bytes))
    }
    fn to_wire(self) -> [u8; 8] {
        self.to_bits().to_wire()
    }
}

impl sealed::Sealed for f64 {}
impl Scalar for f64 {
    fn from_wire(bytes: &[u8]) -> Self {
        f64::from_bits(u64::from_wire(bytes))
    }
    fn to_wire(self) -> [u8; 8] {
        self.to_bits().to_wire()
    }
}

macro_rules! markers {
    ($($(#[$doc:meta])* $name:ident),*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub enum $name {}
        impl sealed::Sealed for $name {}
    )*};
}
markers! {
    /// Access `ro`: the master reads, the device writes.
    Ro,
    /// Access `wo`: the master writes, the device reads.
    Wo,
    /// Access `rw`: both read and write.
    Rw,
    /// Access `rwr`: `rw`, in a PDO only from device to master.
    Rwr,
    /// Access `rww`: `rw`, in a PDO only from master to device.
    Rww,
    /// Access `const`: the value never changes.
    Const,
    /// PDOMapping=1: the value can be mapped into a PDO.
    Pdo,
    /// PDOMapping=0: the value cannot be mapped into a PDO.
    NoPdo
}

/// An access type under which the device may change the value: all but `const`.
///
/// ```
/// use od_model::typed::{DeviceWritable, NoPdo, Scalar, Var};
///
/// /// Accepts a handle of an object that is not `const`; for another it does not compile.
/// fn set<T: Scalar, A: DeviceWritable>(_: Var<T, A, NoPdo>, _: T) {}
/// ```
#[diagnostic::on_unimplemented(
    message = "this object is `const` in the EDS: the device may not change it",
    label = "AccessType=const",
    note = "if the device has to change it, its access type is `ro`: read only for the master"
)]
pub trait DeviceWritable: sealed::Sealed {}
impl DeviceWritable for Ro {}
impl DeviceWritable for Wo {}
impl DeviceWritable for Rw {}
impl DeviceWritable for Rwr {}
impl DeviceWritable for Rww {}

/// A PDOMapping flag of a value that can be mapped into a PDO.
///
/// ```
/// use od_model::typed::{MapEntry, Mappable, Var};
///
/// /// Only a mappable object has an entry for the mapping of a PDO.
/// fn entry<T, A, M: Mappable>(var: Var<T, A, M>) -> MapEntry {
///     var.map()
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "this object cannot be mapped into a PDO",
    label = "it has PDOMapping=0",
    note = "map one whose EDS section says PDOMapping=1, or whose row says `mappable = true`"
)]
pub trait Mappable: sealed::Sealed {}
impl Mappable for Pdo {}

/// A trait that no type implements: the compiler's error for [`Text::map`] gives the reason.
#[doc(hidden)]
#[diagnostic::on_unimplemented(
    message = "a string or a domain cannot be mapped into a PDO",
    label = "its length is not known before it is sent",
    note = "a PDO carries numbers of fixed length; a master reads a text by SDO"
)]
pub trait FixedLength {}

/// Handle of one value: `T` is its Rust type, `A` its access type, `M` its PDO mapping flag.
///
/// The types of 24, 40, 48 and 56 bits are the next larger Rust integer; higher bits are
/// lost when such a value is set.
///
/// ```
/// use od_model::typed::{NoPdo, Rw, Var};
/// use od_model::{Address, Slot};
///
/// // The macro makes such constants, with the place of the value.
/// const HEARTBEAT: Var<u16, Rw, NoPdo> = Var::new(Address::new(0x1017, 0), Slot { offset: 4, len: 2 }, 16);
/// assert_eq!(HEARTBEAT.address().to_string(), "1017h:00");
/// ```
pub struct Var<T, A, M = NoPdo> {
    address: Address,
    slot: Slot,
    bits: u8,
    marker: Marker<(T, A, M)>,
}

impl<T, A, M> Clone for Var<T, A, M> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T, A, M> Copy for Var<T, A, M> {}
impl<T, A, M> core::fmt::Debug for Var<T, A, M> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        core::fmt::Display::fmt(&self.address, f)
    }
}

/// A handle is compared with the address that an application gets: `address == dictionary::LIMIT`.
impl<T, A, M> PartialEq<Var<T, A, M>> for Address {
    fn eq(&self, other: &Var<T, A, M>) -> bool {
        *self == other.address
    }
}

/// A handle of a text is compared like that of a number.
impl<A> PartialEq<Text<A>> for Address {
    fn eq(&self, other: &Text<A>) -> bool {
        *self == other.address
    }
}

impl<T, A, M> Var<T, A, M> {
    /// For generated code: the handle of the entry at `address`, `bits` long in a PDO.
    pub const fn new(address: Address, slot: Slot, bits: u8) -> Self {
        Self {
            address,
            slot,
            bits,
            marker: PhantomData,
        }
    }

    /// Index and sub-index.
    pub const fn address(self) -> Address {
        self.address
    }

    /// Place of the value in the store.
    pub const fn slot(self) -> Slot {
        self.slot
    }

    /// Decodes the little-endian bytes that a master sends, such as those that
    /// `Application::validate` gets. Missing bytes count as 0, or as copies of the sign for a
    /// signed type.
    ///
    /// ```
    /// use od_model::typed::{Rw, Var};
    /// use od_model::{Address, Slot};
    ///
    /// const LIMIT: Var<f32, Rw> = Var::new(Address::new(0x2003, 0), Slot { offset: 0, len: 4 }, 32);
    /// let address = Address::new(0x2003, 0);
    /// assert!(address == LIMIT);
    /// assert_eq!(LIMIT.decode(&80.5f32.to_le_bytes()), 80.5);
    /// ```
    pub fn decode(self, bytes: &[u8]) -> T
    where
        T: Scalar,
    {
        T::from_wire(bytes)
    }

    /// Mapping entry of this value: index, sub-index and length in the form of 1A00h.
    pub const fn map(self) -> MapEntry
    where
        M: Mappable,
    {
        MapEntry {
            address: self.address,
            bits: self.bits,
        }
    }
}

/// Handles of the sub-objects of a long ARRAY, which are consecutive and have one type.
///
/// The macro makes one for an ARRAY of more than 64 sub-objects, instead of a constant for each.
///
/// ```
/// use od_model::typed::{Ro, Series, Var};
/// use od_model::{Address, Slot};
///
/// let slot = Slot { offset: 8, len: 2 };
/// let samples: Series<u16, Ro> = Series::new(Var::new(Address::new(0x2100, 1), slot, 16), 100);
/// let last = samples.at(100).unwrap();
/// assert_eq!((last.address().sub, last.slot().offset), (100, 206));
/// assert!(samples.at(0).is_none() && samples.at(101).is_none());
/// assert_eq!(samples.iter().count(), 100);
/// ```
pub struct Series<T, A, M = NoPdo> {
    first: Var<T, A, M>,
    count: u8,
}

impl<T, A, M> Clone for Series<T, A, M> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T, A, M> Copy for Series<T, A, M> {}
impl<T, A, M> core::fmt::Debug for Series<T, A, M> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(
            f,
            "{:?} and {} more",
            self.first,
            self.count.saturating_sub(1)
        )
    }
}

impl<T, A, M> Series<T, A, M> {
    /// For generated code: `count` handles from the first one on.
    pub const fn new(first: Var<T, A, M>, count: u8) -> Self {
        Self { first, count }
    }

    /// Number of handles.
    pub const fn count(self) -> u8 {
        self.count
    }

    /// The handle of a sub-index; `None` if the series does not have it.
    pub const fn at(self, sub: u8) -> Option<Var<T, A, M>> {
        let Address { index, sub: first } = self.first.address;
        if sub < first || sub - first >= self.count {
            return None;
        }
        let Slot { offset, len } = self.first.slot;
        let offset = offset + (sub - first) as u32 * len as u32;
        let slot = Slot { offset, len };
        Some(Var::new(Address::new(index, sub), slot, self.first.bits))
    }

    /// All handles, by ascending sub-index.
    pub fn iter(self) -> impl Iterator<Item = Var<T, A, M>> {
        let first = self.first.address.sub;
        (0..self.count).filter_map(move |at| self.at(first.saturating_add(at)))
    }
}

/// Handle of a string or domain: VISIBLE_STRING, OCTET_STRING, UNICODE_STRING, DOMAIN.
///
/// ```
/// use od_model::typed::{Ro, Text};
/// use od_model::{Address, Slot};
///
/// const NAME: Text<Ro> = Text::new(Address::new(0x1008, 0), Slot { offset: 8, len: 16 });
/// assert_eq!(NAME.slot().len, 16);
/// ```
pub struct Text<A> {
    address: Address,
    slot: Slot,
    marker: Marker<A>,
}

impl<A> Clone for Text<A> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<A> Copy for Text<A> {}
impl<A> core::fmt::Debug for Text<A> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        core::fmt::Display::fmt(&self.address, f)
    }
}

impl<A> Text<A> {
    /// For generated code: the handle of the entry at `address`.
    pub const fn new(address: Address, slot: Slot) -> Self {
        Self {
            address,
            slot,
            marker: PhantomData,
        }
    }

    /// Index and sub-index.
    pub const fn address(self) -> Address {
        self.address
    }

    /// Does not compile, since a string cannot be mapped into a PDO; the error message says so.
    #[doc(hidden)]
    pub const fn map(self) -> MapEntry
    where
        Self: FixedLength,
    {
        MapEntry {
            address: self.address,
            bits: 0,
        }
    }

    /// Place of the string in the store; two bytes of it are the length.
    pub const fn slot(self) -> Slot {
        self.slot
    }
}

/// One entry of a PDO mapping (CiA 301, objects 1600h–17FFh and 1A00h–1BFFh).
///
/// ```
/// use od_model::Address;
/// use od_model::typed::MapEntry;
///
/// let entry = MapEntry::parse(0x6004_0020);
/// assert_eq!((entry.address, entry.bits), (Address::new(0x6004, 0), 32));
/// assert_eq!(entry.raw(), 0x6004_0020);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct MapEntry {
    /// Address of the mapped value.
    pub address: Address,
    /// Length in bits: the length of the whole value, 1 to 64, unless a mapping object gives
    /// another.
    pub bits: u8,
}

impl MapEntry {
    /// Reads the value of a mapping object; every number is valid.
    pub const fn parse(raw: u32) -> Self {
        let [bits, sub, low, high] = raw.to_le_bytes();
        Self {
            address: Address::new(u16::from_le_bytes([low, high]), sub),
            bits,
        }
    }

    /// The value of the mapping object: `index << 16 | sub << 8 | bits`.
    pub const fn raw(self) -> u32 {
        (self.address.index as u32) << 16 | (self.address.sub as u32) << 8 | self.bits as u32
    }
}

/// A PDO mapping of `N` entries, known to fit into one frame.
///
/// ```
/// use od_model::typed::{MapEntry, pdo};
///
/// let mapping = pdo([MapEntry::parse(0x6004_0020), MapEntry::parse(0x6030_0110)]);
/// assert_eq!(mapping.entries().iter().map(|entry| u32::from(entry.bits)).sum::<u32>(), 48);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Mapping<const N: usize> {
    entries: [MapEntry; N],
}

impl<const N: usize> Mapping<N> {
    /// The entries, in their order in the frame.
    pub const fn entries(&self) -> &[MapEntry; N] {
        &self.entries
    }
}

/// A PDO mapping. In a `const`, more than 64 bits do not compile.
///
/// # Panics
/// If the entries together are longer than the 64 bits of a CAN frame
/// (CiA 301, chapter 7.5.2.36: abort 06040042h).
#[must_use]
#[track_caller]
pub const fn pdo<const N: usize>(entries: [MapEntry; N]) -> Mapping<N> {
    let mut bits = 0u32;
    let mut i = 0;
    while i < N {
        bits += entries[i].bits as u32;
        i += 1;
    }
    assert!(
        bits <= 64,
        "this PDO mapping is longer than the 64 bits of a CAN frame"
    );
    Mapping { entries }
}

#[doc(hidden)]
pub mod emit;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scalars_keep_their_sign_at_every_width() {
        assert_eq!(i32::from_wire(&[0xFF, 0xFF, 0xFF]), -1, "INTEGER24");
        assert_eq!(u32::from_wire(&[0xFF, 0xFF, 0xFF]), 0xFF_FFFF);
        assert_eq!(i64::from_wire(&[0, 0, 0, 0, 0x80]), -(1 << 39), "INTEGER40");
        assert_eq!(f32::from_wire(&1.5f32.to_le_bytes()), 1.5);
        assert_eq!(
            (-2i16).to_wire(),
            [0xFE, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF]
        );
    }

    #[test]
    fn a_mapping_is_the_value_of_1a00h() {
        const POSITION: Var<u32, Ro, Pdo> =
            Var::new(Address::new(0x6004, 0), Slot { offset: 0, len: 4 }, 32);
        const TPDO1: Mapping<2> = pdo([POSITION.map(), POSITION.map()]);
        assert_eq!(TPDO1.entries()[0].raw(), 0x6004_0020);
        assert_eq!(MapEntry::parse(0x6004_0020), POSITION.map());
    }
}
