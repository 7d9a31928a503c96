//! Acceptance filters for the CAN-IDs that a node listens to.

use od_wire::CanId;

/// Frames that a CAN controller accepts: those whose CAN-ID equals `id` in the bits that are 1 in
/// `mask`.
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Filter {
    /// The CAN-ID, of 11 or 29 bits; the filter accepts only frames of the same length.
    pub id: CanId,
    /// Bits of the CAN-ID that are compared; all of them: 7FFh or 1FFF_FFFFh.
    pub mask: u32,
}

impl From<CanId> for Filter {
    fn from(id: CanId) -> Self {
        Self::of(id)
    }
}

impl Filter {
    const fn of(id: CanId) -> Self {
        let mask = if id.is_extended() { 0x1FFF_FFFF } else { 0x7FF };
        Self { id, mask }
    }

    /// Returns whether the filter accepts frames with this CAN-ID, data or remote.
    pub const fn accepts(&self, id: CanId) -> bool {
        self.id.is_extended() == id.is_extended() && (self.id.raw() ^ id.raw()) & self.mask == 0
    }

    /// Returns whether the filter accepts all frames that another one accepts.
    const fn covers(&self, other: &Self) -> bool {
        self.mask & !other.mask == 0 && self.accepts(other.id)
    }

    /// The narrowest filter that accepts the frames of both; `None` if their CAN-IDs differ in
    /// length.
    fn with(&self, other: &Self) -> Option<Self> {
        if self.id.is_extended() != other.id.is_extended() {
            return None;
        }
        let mask = self.mask & other.mask & !(self.id.raw() ^ other.id.raw());
        let raw = self.id.raw() & mask;
        let id = if self.id.is_extended() {
            CanId::extended(raw)
        } else {
            CanId::standard(raw as u16)
        };
        Some(Self { id, mask })
    }

    /// Number of CAN-IDs that it accepts.
    fn width(&self) -> u32 {
        let bits = if self.id.is_extended() { 29 } else { 11 };
        1 << (bits - self.mask.count_ones())
    }
}

/// At most `N` filters (two or more) that accept all frames that a node listens to.
///
/// Each CAN-ID has a filter of its own while there is room. After that, two filters become one for
/// each new CAN-ID: the two whose union accepts the fewest additional frames. A frame that is not
/// for the node costs only time.
///
/// ```
/// use od_board::Filters;
/// use od_board::wire::CanId;
///
/// let ids = [0, 0x80, 0x601, 0x80].map(CanId::standard);
/// let filters: Filters<2> = ids.into_iter().collect();
/// assert_eq!(filters.as_slice().len(), 2);
/// assert_eq!((filters.as_slice()[0].id.raw(), filters.as_slice()[0].mask), (0, 0x77F));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Filters<const N: usize> {
    filters: [Filter; N],
    len: usize,
}

impl<const N: usize> Filters<N> {
    const NONE: Self = {
        assert!(N >= 2, "one filter for 11 bits and one for 29 bits");
        Self {
            filters: [Filter::of(CanId::standard(0)); N],
            len: 0,
        }
    };

    /// The filters.
    pub fn as_slice(&self) -> &[Filter] {
        self.filters.get(..self.len).unwrap_or_default()
    }

    /// Also accepts these frames.
    pub fn add(&mut self, new: impl Into<Filter>) {
        let new = new.into();
        if self.as_slice().iter().any(|filter| filter.covers(&new)) {
            return;
        }
        if self.len == N
            && let Some((first, second, joined)) = self.cheapest(&new)
        {
            self.filters[first] = joined;
            if let Some(second) = second {
                self.filters[second] = new;
            }
        } else if let Some(room) = self.filters.get_mut(self.len) {
            *room = new;
            self.len += 1;
        }
    }

    /// Finds the two filters, of all and `new`, whose union accepts the fewest additional frames.
    /// Returns their positions, `None` for `new`, and the union.
    fn cheapest(&self, new: &Filter) -> Option<(usize, Option<usize>, Filter)> {
        let filters = self.as_slice();
        let pairs = filters.iter().enumerate().flat_map(|(at, first)| {
            let others = (at + 1..).zip(&filters[at + 1..]);
            let others = others.map(|(at, other)| (Some(at), other));
            others
                .chain([(None, new)])
                .filter_map(move |(to, second)| Some((at, to, first.with(second)?, second, first)))
        });
        let best = pairs.min_by_key(|(_, _, joined, second, first)| {
            joined.width() - (first.width() + second.width()).min(joined.width())
        });
        best.map(|(at, to, joined, ..)| (at, to, joined))
    }
}

impl<const N: usize> Default for Filters<N> {
    fn default() -> Self {
        Self::NONE
    }
}

impl<const N: usize, F: Into<Filter>> FromIterator<F> for Filters<N> {
    fn from_iter<I: IntoIterator<Item = F>>(all: I) -> Self {
        let mut filters = Self::NONE;
        all.into_iter().for_each(|one| filters.add(one));
        filters
    }
}
