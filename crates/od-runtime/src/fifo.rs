//! A queue of fixed length.

use crate::blank::Blank;

/// Queue in the order of arrival, with as many places as `items`. A full queue drops new items,
/// because the first events explain the later ones.
///
/// The functions are those of `Fifo<[T]>`, so that they exist once for all lengths.
#[derive(Clone, Copy, Debug)]
pub struct Fifo<Q: ?Sized> {
    span: Span,
    items: Q,
}

/// The occupied places of a queue of any type: consecutive from the first one, and around the end.
#[derive(Clone, Copy, Debug)]
struct Span {
    head: u8,
    len: u8,
}

impl Span {
    const NONE: Self = Self { head: 0, len: 0 };

    /// Place of the item with this distance from the first one.
    #[inline]
    fn place(self, at: u8, room: usize) -> usize {
        let at = usize::from(self.head) + usize::from(at);
        match at.checked_sub(room) {
            Some(wrapped) => wrapped,
            None => at,
        }
    }

    /// Occupies the next place, if one is free.
    fn push(&mut self, room: usize) -> Option<usize> {
        let has_room = usize::from(self.len) < room;
        has_room.then(|| {
            self.len += 1;
            self.place(self.len - 1, room)
        })
    }

    /// Frees the first place, and returns it.
    fn pop(&mut self, room: usize) -> usize {
        let first = self.head.into();
        self.head = self.place(1, room) as u8;
        self.len = self.len.saturating_sub(1);
        first
    }
}

impl<Q> Fifo<Q> {
    /// An empty queue; `items` (at most 255) is the content of the empty places.
    pub const fn new(items: Q) -> Self {
        Self {
            span: Span::NONE,
            items,
        }
    }
}

impl<Q: Blank> Blank for Fifo<Q> {
    const BLANK: Self = Self::new(Q::BLANK);
}

impl<Q: ?Sized> Fifo<Q> {
    #[inline]
    pub(crate) const fn is_empty(&self) -> bool {
        self.span.len == 0
    }

    pub(crate) const fn clear(&mut self) {
        self.span = Span::NONE;
    }
}

impl<T: Copy> Fifo<[T]> {
    /// Adds an item. Returns whether a place was free.
    pub(crate) fn push(&mut self, item: T) -> bool {
        let place = self.span.push(self.items.len());
        if let Some(place) = place
            && let Some(to) = self.items.get_mut(place)
        {
            *to = item;
        }
        place.is_some()
    }

    #[inline]
    pub(crate) fn pop(&mut self) -> Option<T> {
        if self.is_empty() {
            return None;
        }
        let place = self.span.pop(self.items.len());
        self.items.get(place).copied()
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = T> + '_ {
        (0..self.span.len).filter_map(|at| self.get(at))
    }

    /// Returns the item with this distance from the first one.
    #[inline]
    fn get(&self, at: u8) -> Option<T> {
        let place = self.span.place(at, self.items.len());
        self.items.get(place).copied()
    }

    /// Removes all items for which `which` is true.
    pub(crate) fn remove(&mut self, which: impl Fn(T) -> bool) {
        let mut at = 0;
        while at < self.span.len {
            match self.get(at) {
                Some(item) if which(item) => self.take_out(at),
                _ => at += 1,
            }
        }
    }

    /// Returns the distance of the first item for which `which` is true.
    #[inline]
    pub(crate) fn position(&self, which: impl FnMut(T) -> bool) -> Option<u8> {
        self.iter().position(which).map(|at| at as u8)
    }

    /// Removes the item with this distance from the first one; later items move up.
    pub(crate) fn take_out(&mut self, mut at: u8) {
        while let Some(next) = at.checked_add(1).filter(|next| *next < self.span.len)
            && let Some(item) = self.get(next)
            && let Some(to) = self.items.get_mut(self.span.place(at, self.items.len()))
        {
            *to = item;
            at = next;
        }
        self.span.len = self.span.len.saturating_sub(1);
    }
}

#[cfg(test)]
impl<T: Copy, const N: usize> Fifo<[T; N]> {
    pub(crate) fn pop(&mut self) -> Option<T> {
        let queue: &mut Fifo<[T]> = self;
        queue.pop()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_order_and_refuses_when_full() {
        let fifo: &mut Fifo<[u8]> = &mut Fifo::new([0; 3]);
        for round in 0..5 {
            assert!(fifo.push(round) && fifo.push(round + 1) && fifo.push(round + 2));
            assert!(!fifo.push(99));
            fifo.remove(|item| item == round + 1);
            fifo.remove(|item| item == 99);
            assert_eq!(fifo.pop(), Some(round));
            assert_eq!(fifo.pop(), Some(round + 2));
            assert_eq!(fifo.pop(), None);
            assert!(fifo.is_empty());
        }
    }

    #[test]
    fn a_queue_without_places_accepts_nothing() {
        let fifo: &mut Fifo<[u8]> = &mut Fifo::new([]);
        assert!(!fifo.push(1));
        assert_eq!((fifo.pop(), fifo.iter().next()), (None, None));
    }
}
