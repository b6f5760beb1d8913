//! Least-recently-used cache of objects that are created when first needed.
//!
//! Pipelines have many variants: one for each combination of the host's formats and the effects that are drawn. When
//! the cache is full, a new object replaces the least recently used one, so that memory stays bounded however long a
//! session changes between variants.

/// Values found by their keys; at most `MOST` of them.
pub(crate) struct LruCache<K, V, const MOST: usize> {
    all: Vec<RecentEntry<K, V>>,
    uses: u64,
}

struct RecentEntry<K, V> {
    key: K,
    value: V,
    used: u64,
}

impl<K, V, const MOST: usize> Default for LruCache<K, V, MOST> {
    fn default() -> Self {
        Self::new()
    }
}

impl<K, V, const MOST: usize> LruCache<K, V, MOST> {
    pub const fn new() -> Self {
        Self { all: Vec::new(), uses: 0 }
    }

    /// Returns the value whose key satisfies `is`; `make` creates value and key if there is none.
    ///
    /// # Errors
    /// The errors of `make`; the cache then stays as it was.
    pub fn get_or_make<E>(
        &mut self,
        is: impl Fn(&K) -> bool,
        make: impl FnOnce() -> Result<(K, V), E>,
    ) -> Result<&V, E> {
        self.uses += 1;
        let at = match self.all.iter().position(|held| is(&held.key)) {
            Some(at) => at,
            None => self.put(make()?),
        };
        self.all[at].used = self.uses;
        Ok(&self.all[at].value)
    }

    /// Whether there is a value whose key satisfies `is`.
    pub fn has(&self, is: impl Fn(&K) -> bool) -> bool {
        self.all.iter().any(|held| is(&held.key))
    }

    /// Iterates over all keys.
    #[cfg(test)]
    pub fn keys(&self) -> impl Iterator<Item = &K> {
        self.all.iter().map(|held| &held.key)
    }

    /// Returns a copy of the value of `key`; `make` creates the value if there is none.
    pub fn get_or_put(&mut self, key: &K, make: impl FnOnce() -> V) -> V
    where
        K: Copy + PartialEq,
        V: Copy,
    {
        let made = self.get_or_make(|known| known == key, || Ok::<_, std::convert::Infallible>((*key, make())));
        let Ok(value) = made;
        *value
    }

    /// Stores the entry in a free place, or in place of the least recently used one; returns the index.
    fn put(&mut self, (key, value): (K, V)) -> usize {
        let held = RecentEntry { key, value, used: 0 };
        if self.all.len() < MOST {
            self.all.push(held);
            return self.all.len() - 1;
        }
        let oldest = (0..self.all.len()).min_by_key(|at| self.all[*at].used).unwrap_or(0);
        self.all[oldest] = held;
        oldest
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    #[test]
    fn the_cache_holds_at_most_its_capacity_and_keeps_values_in_use() {
        let mut held = LruCache::<u32, Arc<u32>, 8>::new();
        let mut made = Vec::new();
        let mut ask = |key: u32| {
            let make = || {
                let value = Arc::new(key);
                made.push(Arc::downgrade(&value));
                Ok::<_, ()>((key, value))
            };
            assert_eq!(**held.get_or_make(|k| *k == key, make).unwrap(), key);
            made.iter().filter(|m| m.strong_count() > 0).count()
        };
        for round in 0..100 {
            // Three keys that every round uses, and one that is always new.
            let others = [0, 1, 2, 1000 + round];
            assert!(others.into_iter().map(&mut ask).max() <= Some(8));
        }
        // The three values were created once.
        assert_eq!(made.len(), 103);
        assert!(held.get_or_make(|k| *k == 7, || Err("no shader")).is_err());
        assert_eq!(made.iter().filter(|m| m.strong_count() > 0).count(), 8);
    }
}
