//! A queue of fixed room.

/// First in, first out, `N` at most. When full, the newest is not taken: what
/// happened first explains the rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fifo<T, const N: usize> {
    items: [Option<T>; N],
    head: usize,
    len: usize,
}

impl<T: Copy, const N: usize> Default for Fifo<T, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Copy, const N: usize> Fifo<T, N> {
    pub(crate) const fn new() -> Self {
        Self {
            items: [None; N],
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
        if self.len >= N {
            return false;
        }
        let mut at = self.head + self.len;
        if at >= N {
            at -= N;
        }
        self.items[at] = Some(item);
        self.len += 1;
        true
    }

    #[inline]
    pub(crate) fn pop(&mut self) -> Option<T> {
        if self.len == 0 {
            return None;
        }
        let item = self.items[self.head].take();
        self.head += 1;
        if self.head >= N {
            self.head = 0;
        }
        self.len -= 1;
        item
    }

    pub(crate) fn clear(&mut self) {
        *self = Self::new();
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = T> + '_ {
        (0..self.len).filter_map(|i| self.items[(self.head + i) % N])
    }

    /// Takes the first item out that `which` names; answers whether there was one.
    pub(crate) fn remove(&mut self, mut which: impl FnMut(&T) -> bool) -> bool {
        let mut kept = Self::new();
        let mut removed = false;
        while let Some(item) = self.pop() {
            if !removed && which(&item) {
                removed = true;
            } else {
                kept.push(item);
            }
        }
        *self = kept;
        removed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_order_and_refuses_when_full() {
        let mut fifo: Fifo<u8, 3> = Fifo::new();
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
