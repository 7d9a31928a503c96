//! Content of an empty place of an array. The trait has a file of its own because every type in an
//! array implements it, and [`rooms`](crate::rooms) imports all of them.

use core::fmt::Debug;

use od_wire::Frame;

/// Content of an empty place.
pub trait Blank: Clone + Debug + Send {
    /// All zeros where the type allows it, so that a static node takes no flash.
    const BLANK: Self;
}

impl Blank for u8 {
    const BLANK: Self = 0;
}

impl Blank for u32 {
    const BLANK: Self = 0;
}

impl Blank for Frame {
    const BLANK: Self = Self::standard(0, &[]);
}

impl<T: Blank, const N: usize> Blank for [T; N] {
    const BLANK: Self = [const { T::BLANK }; N];
}

#[cfg(any(feature = "std", test))]
impl<T: Blank> Blank for std::vec::Vec<T> {
    const BLANK: Self = Self::new();
}
