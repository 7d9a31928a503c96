//! A queue of fixed room.

/// First in, first out, as many as `items` has room for. When full, the newest is not taken: what
/// happened first explains the rest.
///
/// Its functions are those of `Fifo<[T]>`, so that they exist once, whatever the room.
#[derive(Clone, Copy, Debug)]
pub struct Fifo<Q: ?Sized> {
    head: u8,
    len: u8,
    items: Q,
}

impl<Q> Fifo<Q> {
    /// An empty queue; `items` is the content of empty places, 255 at most.
    pub(crate) const fn new(items: Q) -> Self {
        Self {
            head: 0,
            len: 0,
            items,
        }
    }
}

impl<Q: ?Sized> Fifo<Q> {
    #[inline]
    pub(crate) const fn is_empty(&self) -> bool {
        self.len == 0
    }

    pub(crate) const fn clear(&mut self) {
        self.head = 0;
        self.len = 0;
    }
}

impl<T: Copy> Fifo<[T]> {
    /// The place of the item that is `at` behind the first one.
    #[inline]
    fn place(&self, at: u8) -> usize {
        let at = usize::from(self.head) + usize::from(at);
        match at.checked_sub(self.items.len()) {
            Some(wrapped) => wrapped,
            None => at,
        }
    }

    /// Answers whether there was room.
    #[inline(never)]
    pub(crate) fn push(&mut self, item: T) -> bool {
        let has_room = usize::from(self.len) < self.items.len();
        let place = self.place(self.len);
        if has_room && let Some(to) = self.items.get_mut(place) {
            *to = item;
            self.len += 1;
        }
        has_room
    }

    #[inline]
    pub(crate) fn pop(&mut self) -> Option<T> {
        if self.len == 0 {
            return None;
        }
        let item = self.items.get(usize::from(self.head)).copied();
        self.head = self.place(1) as u8;
        self.len -= 1;
        item
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = T> + '_ {
        (0..self.len).filter_map(|at| self.items.get(self.place(at)).copied())
    }

    /// Takes the first item out that `which` names; answers whether there was one.
    pub(crate) fn remove(&mut self, mut which: impl FnMut(&T) -> bool) -> bool {
        let mut removed = false;
        for _ in 0..self.len {
            match self.pop() {
                Some(item) if !removed && which(&item) => removed = true,
                Some(item) => _ = self.push(item),
                None => break,
            }
        }
        removed
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
            assert!(fifo.remove(|item| *item == round + 1));
            assert!(!fifo.remove(|item| *item == 99));
            assert_eq!(fifo.pop(), Some(round));
            assert_eq!(fifo.pop(), Some(round + 2));
            assert_eq!(fifo.pop(), None);
            assert!(fifo.is_empty());
        }
    }

    #[test]
    fn without_room_it_takes_nothing() {
        let fifo: &mut Fifo<[u8]> = &mut Fifo::new([]);
        assert!(!fifo.push(1));
        assert_eq!((fifo.pop(), fifo.iter().next()), (None, None));
    }
}
