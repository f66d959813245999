//! Additional results of a step.

use smallvec::SmallVec;

/// Named numbers of a step: `success`, the return of an episode, a distance. Up to three are stored inline, so that a step
/// allocates nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Info {
    entries: SmallVec<[(&'static str, f64); 3]>,
}

impl Info {
    /// Returns the value of `key`.
    pub fn get(&self, key: &str) -> Option<f64> {
        self.entries.iter().find_map(|(name, value)| (*name == key).then_some(*value))
    }

    /// Returns whether the episode reached its goal: `success` above 0.5; `None` without that key.
    pub fn success(&self) -> Option<bool> {
        self.get("success").map(|success| success > 0.5)
    }

    /// Sets the value of `key`.
    pub fn set(&mut self, key: &'static str, value: f64) {
        match self.entries.iter_mut().find(|(name, _)| *name == key) {
            Some((_, old)) => *old = value,
            None => self.entries.push((key, value)),
        }
    }

    /// Returns the same info with a value set, as by [`Self::set`].
    #[must_use]
    pub fn with(mut self, key: &'static str, value: f64) -> Self {
        self.set(key, value);
        self
    }

    /// Returns keys and values in the order in which they were set.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&'static str, f64)> + '_ {
        self.entries.iter().copied()
    }

    /// Removes all values.
    pub fn clear(&mut self) {
        self.entries.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_has_one_value() {
        let info = Info::default().with("success", 0.0).with("distance", 2.5).with("success", 1.0);
        assert_eq!(info.iter().collect::<Vec<_>>(), [("success", 1.0), ("distance", 2.5)]);
        assert_eq!((info.get("distance"), info.get("length")), (Some(2.5), None));
    }
}
