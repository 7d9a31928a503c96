//! What a place of an array holds before anything is put into it: a file of its own, since all that an array holds
//! needs it, and [`rooms`](crate::rooms) needs all of them.

use core::fmt::Debug;

use od_wire::Frame;

/// Content of a place that nothing has been put into.
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
