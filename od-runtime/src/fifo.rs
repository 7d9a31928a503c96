//! A queue of fixed room.

/// First in, first out, `N` at most. When full, the newest is not taken: what
/// happened first explains the rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fifo<T, const N: usize> {
    items: [T; N],
    head: usize,
    len: usize,
}

impl<T: Copy, const N: usize> Fifo<T, N> {
    /// An empty queue; `fill` is the content of empty places.
    pub(crate) const fn new(fill: T) -> Self {
        Self {
            items: [fill; N],
            head: 0,
            len: 0,
        }
    }

    #[inline]
    pub(crate) const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Answers whether there was room.
    #[inline]
    pub(crate) fn push(&mut self, item: T) -> bool {
        let room = self.len < N;
        if room {
            self.items[(self.head + self.len) % N] = item;
            self.len += 1;
        }
        room
    }

    #[inline]
    pub(crate) fn pop(&mut self) -> Option<T> {
        if self.len == 0 {
            return None;
        }
        let item = self.items[self.head % N];
        self.head = (self.head + 1) % N;
        self.len -= 1;
        Some(item)
    }

    pub(crate) fn clear(&mut self) {
        self.head = 0;
        self.len = 0;
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = T> + '_ {
        (0..self.len).map(|i| self.items[(self.head + i) % N])
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
mod tests {
    use super::*;

    #[test]
    fn keeps_order_and_refuses_when_full() {
        let mut fifo: Fifo<u8, 3> = Fifo::new(0);
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
}
