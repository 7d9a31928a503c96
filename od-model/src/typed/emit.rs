//! What generated code is written with; not an API.

pub use super::{Const, NoPdo, Pdo, Ro, Rw, Rwr, Rww, Text, Var, Wo};
use crate::{Address, Slot};

pub const fn __v<T, A, M>(index: u16, sub: u8, offset: u32, len: u16, bits: u8) -> Var<T, A, M> {
    Var::new(Address::new(index, sub), Slot { offset, len }, bits)
}

pub const fn __t<A>(index: u16, sub: u8, offset: u32, len: u16) -> Text<A> {
    Text::new(Address::new(index, sub), Slot { offset, len })
}

/// One short call a row: what 6,000 rows cost to compile is what one costs.
pub mod table {
    pub use crate::{
        Access as A, DataType as T, Entry, Object, ObjectCode as C, Place, bucket_count, buckets,
        places,
    };
    use crate::{Address, Dictionary, Group, Literal, Range, Slot};

    /// Without the checks of [`Dictionary::new`], which thousands of entries would
    /// wait for: the macro takes its tables out of [`Tables`](crate::Tables).
    pub const fn d(
        buckets: &'static [u16],
        places: &'static [Place],
        objects: &'static [Object],
        entries: &'static [Entry],
        text: &'static str,
        blob: &'static [u8],
        store_len: usize,
    ) -> Dictionary<'static> {
        Dictionary::trusted(buckets, places, objects, entries, text, blob, store_len)
    }

    pub const GN: Group = Group::None;
    pub const GC: Group = Group::Communication;
    pub const GA: Group = Group::Application;
    pub const GM: Group = Group::Manufacturer;
    pub const N: Literal = Literal::None;
    pub use Literal::{NodeId as D, Real as R, Signed as S, Unsigned as U};

    pub const fn t(start: u32, len: u32) -> Literal {
        Literal::Text(Range::new(start, len))
    }

    pub const fn b(start: u32, len: u32) -> Literal {
        Literal::Bytes(Range::new(start, len))
    }

    pub const fn o(
        index: u16,
        code: C,
        name: u32,
        name_len: u32,
        first: u32,
        count: u16,
    ) -> Object {
        Object {
            index,
            code,
            name: Range::new(name, name_len),
            first,
            count,
        }
    }

    #[allow(clippy::too_many_arguments)] // a row of a table
    pub const fn e(
        index: u16,
        sub: u8,
        data_type: T,
        access: A,
        mappable: bool,
        group: Group,
        name: u32,
        name_len: u32,
        default: Literal,
        low: Literal,
        high: Literal,
        offset: u32,
        len: u16,
    ) -> Entry {
        Entry {
            address: Address::new(index, sub),
            data_type,
            access,
            mappable,
            group,
            name: Range::new(name, name_len),
            default,
            low,
            high,
            slot: Slot { offset, len },
        }
    }
}
