//! Default values and limits of a description.

/// A range of [`Dictionary::text`](crate::Dictionary::text) or
/// [`Dictionary::blob`](crate::Dictionary::blob): start and length in bytes.
///
/// ```
/// use od_model::Range;
///
/// assert_eq!(Range::new(2, 3).of(b"abcdefg"), b"cde");
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Range {
    /// First byte.
    pub start: u32,
    /// Number of bytes.
    pub len: u32,
}

impl Range {
    /// `len` bytes from `start`.
    pub const fn new(start: u32, len: u32) -> Self {
        Self { start, len }
    }

    /// The bytes of `arena` in this range; empty if the range reaches outside.
    pub fn of(self, arena: &[u8]) -> &[u8] {
        let start = self.start as usize;
        arena
            .get(start..start.saturating_add(self.len as usize))
            .unwrap_or(&[])
    }
}

/// A value of a description: a default or a limit.
///
/// Texts and byte strings are ranges into the two arenas of the dictionary, so a
/// table of literals has no lifetime, and is the same for a compiled and a loaded dictionary.
///
/// ```
/// use od_model::Literal;
///
/// assert_eq!(Literal::Signed(-1).integer(8), Some(-1));
/// ```
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub enum Literal {
    /// The description gives no value.
    #[default]
    None,
    /// BOOLEAN, UNSIGNED, TIME_OF_DAY and TIME_DIFFERENCE.
    Unsigned(u64),
    /// INTEGER.
    Signed(i64),
    /// REAL32 and REAL64.
    Real(f64),
    /// `$NODEID+n`: depends on the node ID. UNSIGNED8 to UNSIGNED32 only.
    NodeId(u32),
    /// VISIBLE_STRING, in [`Dictionary::text`](crate::Dictionary::text).
    Text(Range),
    /// OCTET_STRING, UNICODE_STRING and DOMAIN, in [`Dictionary::blob`](crate::Dictionary::blob).
    Bytes(Range),
}

impl Literal {
    /// The low 64 bits of [`integer`](Self::integer): the bytes of the value.
    pub const fn bits(self, node_id: u8) -> Option<u64> {
        match self {
            Self::Unsigned(v) => Some(v),
            Self::Signed(v) => Some(v as u64),
            Self::NodeId(offset) => Some(offset as u64 + node_id as u64),
            Self::None | Self::Real(_) | Self::Text(_) | Self::Bytes(_) => None,
        }
    }

    /// The number that this literal is for a node with this ID; `None` for texts, bytes and reals.
    pub const fn integer(self, node_id: u8) -> Option<i128> {
        match self {
            Self::Unsigned(v) => Some(v as i128),
            Self::Signed(v) => Some(v as i128),
            Self::NodeId(offset) => Some(offset as i128 + node_id as i128),
            Self::None | Self::Real(_) | Self::Text(_) | Self::Bytes(_) => None,
        }
    }
}
