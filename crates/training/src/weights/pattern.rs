//! Name patterns with stars.

use opendr_engine::{Error, Result};

/// A name pattern in which `*` matches any text, and its replacement: `features.*.conv.*` -> `blocks.*.*`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Pattern {
    from: String,
    to: String,
}

impl Pattern {
    pub fn new(from: &str, to: &str) -> Self {
        Self { from: from.to_owned(), to: to.to_owned() }
    }

    /// Checks that both sides have the same number of stars.
    pub fn check(&self) -> Result<()> {
        let stars = |text: &str| text.matches('*').count();
        if stars(&self.from) != stars(&self.to) || self.from.contains("**") {
            return Err(Error::invalid_param(format!(
                "renaming {:?} to {:?}: both sides need the same number of stars, with text between them",
                self.from, self.to
            )));
        }
        Ok(())
    }

    /// Returns the replacement of `name`, if it matches. A star matches as little as possible, the last one the rest.
    pub fn renamed(&self, name: &str) -> Option<String> {
        let mut texts = self.from.split('*');
        let mut rest = name.strip_prefix(texts.next()?)?;
        let mut found = Vec::new();
        let mut texts = texts.peekable();
        while let Some(text) = texts.next() {
            let place = match texts.peek() {
                Some(_) => rest.find(text)?,
                None => rest.ends_with(text).then(|| rest.len() - text.len())?,
            };
            found.push(&rest[..place]);
            rest = &rest[place + text.len()..];
        }
        if !rest.is_empty() {
            return None;
        }
        let mut texts = self.to.split('*');
        let mut renamed = texts.next()?.to_owned();
        for (found, text) in found.iter().zip(texts) {
            renamed.push_str(found);
            renamed.push_str(text);
        }
        Some(renamed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_carry_over() {
        let renamed = |from, to, name| Pattern::new(from, to).renamed(name);
        assert_eq!(renamed("module.*", "*", "module.a.weight").as_deref(), Some("a.weight"));
        assert_eq!(renamed("*", "net.*", "a.weight").as_deref(), Some("net.a.weight"));
        assert_eq!(renamed("f.*.conv.*", "b.*.*", "f.10.conv.bias").as_deref(), Some("b.10.bias"));
        assert_eq!(renamed("*.bn.weight", "*.norm.gamma", "f.bn.weight").as_deref(), Some("f.norm.gamma"));
        assert_eq!(renamed("fc.weight", "head.weight", "fc.weight").as_deref(), Some("head.weight"));
        assert_eq!(renamed("fc.weight", "head.weight", "fc.weight2"), None);
        assert_eq!(renamed("module.*", "*", "a.weight"), None);
        assert!(Pattern::new("a.*", "a").check().is_err() && Pattern::new("**", "**").check().is_err());
    }
}
