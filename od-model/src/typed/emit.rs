//! Helpers of generated code; not an API.

pub use super::{Const, NoPdo, Pdo, Ro, Rw, Rwr, Rww, Series, Text, Var, Wo};
pub use crate::__address as __a;
pub use crate::address::Address;
use crate::entry::Slot;

/// Writes the address of a handle as a constant in a module with the name of the handle: a pattern needs a constant of
/// the type `Address`, and a module and a constant may have one name.
#[doc(hidden)]
#[macro_export]
macro_rules! __address {
    ($name:ident $index:literal $sub:literal) => {
        #[doc(hidden)]
        pub mod $name {
            pub const ADDRESS: $crate::typed::emit::Address = $crate::typed::emit::Address {
                index: $index,
                sub: $sub,
            };
        }
    };
}

pub const fn __v<T, A, M>(index: u16, sub: u8, offset: u32, len: u16, bits: u8) -> Var<T, A, M> {
    Var::new(Address::new(index, sub), Slot { offset, len }, bits)
}

pub const fn __s<T, A, M>(first: Var<T, A, M>, count: u8) -> Series<T, A, M> {
    Series::new(first, count)
}

pub const fn __t<A>(index: u16, sub: u8, offset: u32, len: u16) -> Text<A> {
    Text::new(Address::new(index, sub), Slot { offset, len })
}

pub mod table {
    //! The tables of a compiled dictionary as the macro writes them: numbers and bytes.
    //!
    //! A row is one literal, and a `const fn` turns the literals into a table. The compiler runs this
    //! function for each row, where a call takes as long as twenty operators. An expression for each
    //! row would take ten times as long, and an IDE would store each of its tokens. Names are bytes,
    //! which need no conversion.

    pub use crate::dictionary::{Dictionary, Names, Shape};
    pub use crate::index::{Buckets, bucket_count, buckets, small_buckets};
    pub use crate::real::Reals;
    pub use crate::row::Row;
    pub use crate::value::Range;
    pub use crate::varying::Varying;

    /// The rows made of numbers; each number contains the words of a row, the first one lowest.
    #[rustfmt::skip] // a row is a row
    pub const fn rows<const N: usize>(numbers: &[u128; N]) -> [Row; N] {
        let mut rows = [Row([0; 4]); N];
        let mut at = 0;
        while at < N {
            let n = numbers[at];
            rows[at] = Row([n as u32, (n >> 32) as u32, (n >> 64) as u32, (n >> 96) as u32]);
            at += 1;
        }
        rows
    }

    /// The names of a literal.
    pub const fn names(bytes: &'static [u8]) -> &'static [[u8; 16]] {
        bytes.as_chunks().0
    }
}
