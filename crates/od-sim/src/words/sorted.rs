//! A map for few keys, or for keys that arrive in order. Its code has a thirtieth of the size of a
//! `BTreeMap`, which matters in a page.

use std::collections::VecDeque;
use std::prelude::v1::*;

/// Values by ascending key.
#[derive(Clone, Debug)]
pub(super) struct Sorted<K, V>(VecDeque<(K, V)>);

impl<K, V> Default for Sorted<K, V> {
    fn default() -> Self {
        Self(VecDeque::new())
    }
}

impl<K: Ord + Copy, V> Sorted<K, V> {
    fn find(&self, key: K) -> Result<usize, usize> {
        self.0.binary_search_by_key(&key, |(key, _)| *key)
    }

    pub(super) fn get(&self, key: K) -> Option<&V> {
        let at = self.find(key).ok()?;
        self.0.get(at).map(|(_, value)| value)
    }

    pub(super) fn get_mut(&mut self, key: K) -> Option<&mut V> {
        let at = self.find(key).ok()?;
        self.0.get_mut(at).map(|(_, value)| value)
    }

    pub(super) fn get_or_default(&mut self, key: K) -> &mut V
    where
        V: Default,
    {
        let at = self.find(key).unwrap_or_else(|at| {
            self.0.insert(at, (key, V::default()));
            at
        });
        &mut self.0[at].1
    }

    /// Inserts a value; returns the previous value of its key.
    pub(super) fn insert(&mut self, key: K, value: V) -> Option<V> {
        match self.find(key) {
            Ok(at) => Some(std::mem::replace(&mut self.0[at].1, value)),
            Err(at) => {
                self.0.insert(at, (key, value));
                None
            }
        }
    }

    pub(super) fn remove(&mut self, key: K) -> Option<V> {
        let at = self.find(key).ok()?;
        self.0.remove(at).map(|(_, value)| value)
    }

    pub(super) fn retain(&mut self, keep: impl Fn(&V) -> bool) {
        self.0.retain(|(_, value)| keep(value));
    }

    /// Removes all lower keys.
    pub(super) fn forget_before(&mut self, key: K) {
        let at = self.find(key).unwrap_or_else(|at| at);
        self.0.drain(..at);
    }
}

#[cfg(test)]
mod tests {
    use super::Sorted;

    #[test]
    fn it_behaves_like_a_map() {
        let mut map = Sorted::default();
        for key in [5, 1, 9, 5] {
            map.insert(key, key * 10);
        }
        assert_eq!(map.insert(1, 11), Some(10));
        assert_eq!((map.get(1), map.get(2)), (Some(&11), None));
        map.forget_before(5);
        assert_eq!(map.get(1), None);
        assert_eq!(map.remove(5), Some(50));
        assert_eq!(map.remove(5), None);
        map.retain(|value| *value < 90);
        assert!(map.get_mut(9).is_none());
    }
}
