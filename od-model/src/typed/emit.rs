//! Helpers of generated code; not an API.

pub use super::{Const, NoPdo, Pdo, Ro, Rw, Rwr, Rww, Text, Var, Wo};
use crate::address::Address;
use crate::entry::Slot;

pub const fn __v<T, A, M>(index: u16, sub: u8, offset: u32, len: u16, bits: u8) -> Var<T, A, M> {
    Var::new(Address::new(index, sub), Slot { offset, len }, bits)
}

pub const fn __t<A>(index: u16, sub: u8, offset: u32, len: u16) -> Text<A> {
    Text::new(Address::new(index, sub), Slot { offset, len })
}

pub mod table;
