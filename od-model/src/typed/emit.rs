//! Helpers of generated code; not an API.

pub use super::{Const, NoPdo, Pdo, Ro, Rw, Rwr, Rww, Series, Text, Var, Wo};
use crate::address::Address;
use crate::entry::Slot;

pub const fn __v<T, A, M>(index: u16, sub: u8, offset: u32, len: u16, bits: u8) -> Var<T, A, M> {
    Var::new(Address::new(index, sub), Slot { offset, len }, bits)
}

pub const fn __s<T, A, M>(first: Var<T, A, M>, count: u8) -> Series<T, A, M> {
    Series::new(first, count)
}

pub const fn __t<A>(index: u16, sub: u8, offset: u32, len: u16) -> Text<A> {
    Text::new(Address::new(index, sub), Slot { offset, len })
}

pub mod table;
