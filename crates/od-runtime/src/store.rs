//! Values: a slice of the caller, in the layout of the dictionary.

mod error;

use od_model::row::Row;
use od_model::typed::{DeviceWritable, Scalar, Text, Var};
use od_model::varying::Varying;
use od_model::{Address, Dictionary, Entry, Kind, Slot};

use crate::number::{copy, fill, number_in};
use od_wire::{AbortCode, NodeId};

pub use error::{StoreTooSmall, TextTooLong};

/// The current values of a device: a dictionary, and a slice of the caller.
///
/// Typed access uses the handles that `object_dictionary!` makes; services use entries or
/// addresses. A handle of another dictionary reads 0 and writes nothing outside the slice; it never
/// panics.
pub struct Store<'a> {
    dictionary: &'a Dictionary<'a>,
    values: &'a mut [u8],
    node_id: NodeId,
}

impl<'a> Store<'a> {
    /// Uses `values` in the layout of `dictionary`. The bytes stay as they are: call
    /// [`reset`](Self::reset) before the first use.
    ///
    /// # Errors
    /// [`StoreTooSmall`] if `values` is shorter than [`Dictionary::store_len`].
    pub fn new(
        dictionary: &'a Dictionary<'a>,
        values: &'a mut [u8],
        node_id: NodeId,
    ) -> Result<Self, StoreTooSmall> {
        let needed = dictionary.store_len();
        if values.len() < needed {
            return Err(StoreTooSmall { needed });
        }
        Ok(Self {
            dictionary,
            values,
            node_id,
        })
    }

    /// As [`new`](Self::new), for a slice of any length: values past its end read 0 and cannot be
    /// written.
    pub(crate) fn over(
        dictionary: &'a Dictionary<'a>,
        values: &'a mut [u8],
        node_id: NodeId,
    ) -> Self {
        Self {
            dictionary,
            values,
            node_id,
        }
    }

    /// The dictionary.
    #[inline]
    pub fn dictionary(&self) -> &'a Dictionary<'a> {
        self.dictionary
    }

    /// The node ID: the value of `$NODEID`.
    #[inline]
    pub fn node_id(&self) -> NodeId {
        self.node_id
    }

    /// Sets the node ID, and with it the meaning of `$NODEID` defaults.
    pub(crate) fn set_node_id(&mut self, node_id: NodeId) {
        self.node_id = node_id;
    }

    /// All values, in the layout of the dictionary.
    pub(crate) fn values(&self) -> &[u8] {
        let len = self.dictionary.store_len();
        self.values.get(..len).unwrap_or_default()
    }

    /// Sets every value for which `which` is true to its default.
    pub fn reset(&mut self, mut which: impl FnMut(&Row) -> bool) {
        for row in self.dictionary.rows() {
            if which(row) {
                self.reset_row(row);
            }
        }
    }

    /// Sets one value to its default; without a default to 0 or empty.
    pub fn reset_entry(&mut self, entry: &Entry) {
        if let Some(row) = self.dictionary.row_at(entry.address) {
            self.reset_row(row);
        }
    }

    /// Sets one value to its default.
    pub(crate) fn reset_row(&mut self, row: &Row) {
        match varying(self.dictionary, row) {
            // The layout has room for the default; it cannot be longer.
            Some(varying) => {
                _ = self.put_row(row, (varying.value)(self.dictionary.arenas(), &[], row))
            }
            None => self.put_number(row, default(self.dictionary, row, self.node_id)),
        }
    }

    /// Writes a number, cut to its length, if it has a place in the store.
    fn put_number(&mut self, row: &Row, number: u64) {
        if let Some(room) = slot_mut(self.values, row.fixed_slot()) {
            fill(room, number.to_le_bytes());
        }
    }

    /// Returns whether the value is its default.
    pub fn is_default(&self, entry: &Entry) -> bool {
        let row = self.dictionary.row_at(entry.address);
        row.is_some_and(|row| self.has_default(row))
    }

    /// Returns whether the value is its default.
    pub(crate) fn has_default(&self, row: &Row) -> bool {
        let (mut a, mut b) = ([0; 8], [0; 8]);
        let default = match varying(self.dictionary, row) {
            Some(varying) => (varying.value)(self.dictionary.arenas(), &[], row),
            None => default_bytes(self.dictionary, row, self.node_id, &mut b),
        };
        self.value(row, &mut a) == default
    }

    /// The value of a handle.
    #[inline]
    pub fn get<T: Scalar, A, M>(&self, var: Var<T, A, M>) -> T {
        match slot(self.values, var.slot()) {
            Some(bytes) if !bytes.is_empty() => T::from_wire(bytes),
            _ => {
                let mut number = [0; 8];
                T::from_wire(match self.dictionary.row_at(var.address()) {
                    Some(row) => self.value(row, &mut number),
                    None => &[],
                })
            }
        }
    }

    /// Sets the value of a handle. Limits are not checked: they apply to the master, not to the
    /// device.
    #[inline]
    pub fn set<T: Scalar, A: DeviceWritable, M>(&mut self, var: Var<T, A, M>, value: T) {
        if let Some(room) = slot_mut(self.values, var.slot()) {
            fill(room, value.to_wire());
        }
    }

    /// The bytes of a string or domain.
    pub fn text<A>(&self, text: Text<A>) -> &[u8] {
        match self.dictionary.row_at(text.address()) {
            Some(row) => match self.dictionary.varying() {
                Some(varying) => (varying.value)(self.dictionary.arenas(), self.values, row),
                None => &[],
            },
            None => &[],
        }
    }

    /// Sets a string or domain.
    ///
    /// # Errors
    /// [`TextTooLong`] if it does not fit; the value stays unchanged.
    pub fn set_text<A: DeviceWritable>(
        &mut self,
        text: Text<A>,
        bytes: &[u8],
    ) -> Result<(), TextTooLong> {
        let capacity = usize::from(text.slot().len.saturating_sub(2));
        match self.dictionary.row_at(text.address()) {
            Some(row) => self
                .put_row(row, bytes)
                .map_err(|_| TextTooLong { capacity }),
            None => Err(TextTooLong { capacity: 0 }),
        }
    }

    /// The bytes of a slot; empty if it reaches outside.
    #[inline]
    pub(crate) fn slot(&self, of: Slot) -> &[u8] {
        slot(self.values, of).unwrap_or_default()
    }

    /// The bytes of the value as in an SDO. `number` is memory for a `const` number, which is not
    /// in the store.
    pub fn bytes<'b>(&'b self, entry: &Entry, number: &'b mut [u8; 8]) -> &'b [u8] {
        match self.dictionary.row_at(entry.address) {
            Some(row) => self.value(row, number),
            None => &[],
        }
    }

    /// As [`bytes`](Self::bytes).
    pub(crate) fn value<'b>(&'b self, row: &Row, number: &'b mut [u8; 8]) -> &'b [u8] {
        if let Some(varying) = varying(self.dictionary, row) {
            return (varying.value)(self.dictionary.arenas(), self.values, row);
        }
        match self.slot(row.fixed_slot()) {
            [] => default_bytes(self.dictionary, row, self.node_id, number),
            bytes => bytes,
        }
    }

    /// The bytes of a value in the store; for a string that is not in the store, its default.
    #[inline]
    pub(crate) fn stored(&self, row: &Row) -> &[u8] {
        match varying(self.dictionary, row) {
            Some(varying) => (varying.value)(self.dictionary.arenas(), self.values, row),
            None => self.slot(row.fixed_slot()),
        }
    }

    /// The row of the value at an address.
    pub(crate) fn row(&self, address: Address) -> Result<&'a Row, AbortCode> {
        match self.dictionary.row_at(address) {
            Some(row) => Ok(row),
            None => Err(missing(self.dictionary, address)),
        }
    }

    /// Writes the bytes of an SDO, if they have the right length.
    ///
    /// # Errors
    /// [`AbortCode::TooLong`] or [`AbortCode::TooShort`] by the entry's length or capacity;
    /// [`AbortCode::ReadOnly`] if the value is not in the store.
    pub fn put(&mut self, entry: &Entry, bytes: &[u8]) -> Result<(), AbortCode> {
        self.put_row(self.row(entry.address)?, bytes)
    }

    /// As [`put`](Self::put).
    pub(crate) fn put_row(&mut self, row: &Row, bytes: &[u8]) -> Result<(), AbortCode> {
        let room = self.room(row, bytes.len())?;
        copy(room, bytes);
        Ok(())
    }

    /// The place of a value of this length, which a string has from now on; the caller fills it at
    /// once.
    pub(crate) fn room(&mut self, row: &Row, len: usize) -> Result<&mut [u8], AbortCode> {
        if !row.is_stored() {
            return Err(AbortCode::ReadOnly);
        }
        if let Some(varying) = varying(self.dictionary, row) {
            let room = (varying.room)(self.dictionary.arenas(), self.values, row, len);
            return room.ok_or(AbortCode::TooLong);
        }
        let to = slot_mut(self.values, row.fixed_slot()).unwrap_or_default();
        match len {
            len if len < to.len() => Err(AbortCode::TooShort),
            len if len > to.len() => Err(AbortCode::TooLong),
            _ => Ok(to),
        }
    }

    /// The number at an address; 0 if the object is missing or is not an integer.
    pub fn unsigned(&self, index: u16, sub: u8) -> u64 {
        self.try_unsigned(index, sub).unwrap_or(0)
    }

    /// The integer at an address, with its sign if its type has one; 0 if the object is missing or
    /// is not an integer.
    pub fn signed(&self, index: u16, sub: u8) -> i64 {
        let Some(row) = self.dictionary.row_at(Address::new(index, sub)) else {
            return 0;
        };
        let number = self.number_of(row);
        if row.data_type().kind() != Kind::Signed {
            return number as i64;
        }
        let above = u64::BITS.saturating_sub(u32::from(row.bits())).min(63);
        (number << above) as i64 >> above
    }

    /// The bits of the number at an address; `None` if the object is missing.
    pub fn try_unsigned(&self, index: u16, sub: u8) -> Option<u64> {
        let row = self.dictionary.row_at(Address::new(index, sub))?;
        Some(self.number_of(row))
    }

    /// The low 32 bits of the number at an address, in registers; `None` if the object is missing.
    pub(crate) fn try_word(&self, index: u16, sub: u8) -> Option<u32> {
        let row = self.dictionary.row_at(Address::new(index, sub))?;
        Some(self.number_of(row) as u32)
    }

    /// The low 32 bits of the number at an address; `missing` if the object is missing.
    pub(crate) fn word(&self, index: u16, sub: u8, missing: u32) -> u32 {
        match self.dictionary.row_at(Address::new(index, sub)) {
            Some(row) => self.number_of(row) as u32,
            None => missing,
        }
    }

    /// The number in the row's value, little-endian, at most eight bytes.
    pub(crate) fn number_of(&self, row: &Row) -> u64 {
        match self.slot(row.plain()) {
            [] => self.other_number(row),
            bytes => number_in(bytes),
        }
    }

    /// As [`number_of`](Self::number_of), for a value that no master can read, that is a string, or
    /// that is not in the store.
    fn other_number(&self, row: &Row) -> u64 {
        number_in(self.value(row, &mut [0; 8]))
    }

    /// The default of a number, cut to its length.
    fn default_number(&self, row: &Row) -> u64 {
        let default = default(self.dictionary, row, self.node_id).to_le_bytes();
        number_in(default.get(..row.size()).unwrap_or_default())
    }

    /// Returns whether the value of a number is its default, and the default depends on the node
    /// ID.
    pub(crate) fn follows_node_id(&self, row: &Row) -> bool {
        row.follows_node_id() && self.number_of(row) == self.default_number(row)
    }

    /// The number in the entry's value, little-endian, at most eight bytes.
    pub fn number(&self, entry: &Entry) -> u64 {
        number_in(self.bytes(entry, &mut [0; 8]))
    }

    /// Writes a number at an address, cut to the entry's length; `false` if the object does not
    /// exist.
    pub fn set_unsigned(&mut self, address: Address, value: u64) -> bool {
        let Some(row) = self.dictionary.row_at(address) else {
            return false;
        };
        self.put_number(row, value);
        row.fixed_slot().len > 0
    }
}

/// The abort code for a value that does not exist.
fn missing(dictionary: &Dictionary<'_>, address: Address) -> AbortCode {
    dictionary.missing(address).into()
}

#[inline]
fn slot(values: &[u8], slot: Slot) -> Option<&[u8]> {
    values.get(slot.offset as usize..)?.get(..slot.len.into())
}

#[inline]
fn slot_mut(values: &mut [u8], slot: Slot) -> Option<&mut [u8]> {
    let rest = values.get_mut(slot.offset as usize..)?;
    rest.get_mut(..slot.len.into())
}

/// The functions for a value of variable length.
#[inline]
fn varying(dictionary: &Dictionary<'_>, row: &Row) -> Option<&'static Varying> {
    dictionary.varying().filter(|_| row.is_variable())
}

/// The bytes of the default of a number.
fn default_bytes<'b>(
    dictionary: &Dictionary<'b>,
    row: &Row,
    node_id: NodeId,
    number: &'b mut [u8; 8],
) -> &'b [u8] {
    *number = default(dictionary, row, node_id).to_le_bytes();
    number.get(..row.size()).unwrap_or_default()
}

/// The default of a number.
fn default(dictionary: &Dictionary<'_>, row: &Row, node_id: NodeId) -> u64 {
    let default = row.default(dictionary.pool(), node_id.raw());
    match dictionary.reals() {
        Some(reals) if row.kind() == Kind::Real && row.bits() == 32 => {
            (reals.narrowed)(default).into()
        }
        _ => default,
    }
}
