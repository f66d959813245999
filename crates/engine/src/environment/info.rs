//! What an environment tells beside observation and reward.

use smallvec::SmallVec;

/// Named numbers: `success`, an episode's return, a distance. Up to two lie in place, so that a step allocates nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Info {
    entries: SmallVec<[(&'static str, f64); 2]>,
}

impl Info {
    /// The number under `key`.
    pub fn get(&self, key: &str) -> Option<f64> {
        self.entries.iter().find_map(|(name, value)| (*name == key).then_some(*value))
    }

    /// Whether the episode reached its goal: a `success` above 0.5; `None` where that is not told.
    pub fn success(&self) -> Option<bool> {
        self.get("success").map(|success| success > 0.5)
    }

    /// Sets the number under `key`.
    pub fn set(&mut self, key: &'static str, value: f64) {
        match self.entries.iter_mut().find(|(name, _)| *name == key) {
            Some((_, old)) => *old = value,
            None => self.entries.push((key, value)),
        }
    }

    /// Adds a number, as [`Self::set`] does.
    #[must_use]
    pub fn with(mut self, key: &'static str, value: f64) -> Self {
        self.set(key, value);
        self
    }

    /// Keys and numbers in the order in which they were set.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&'static str, f64)> + '_ {
        self.entries.iter().copied()
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.entries.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_has_one_number() {
        let info = Info::default().with("success", 0.0).with("distance", 2.5).with("success", 1.0);
        assert_eq!(info.iter().collect::<Vec<_>>(), [("success", 1.0), ("distance", 2.5)]);
        assert_eq!((info.get("distance"), info.get("length")), (Some(2.5), None));
    }
}
