//! Names of nodes, topics and services, and their remappings.

use opendr_engine::{Error, Result};

/// Name of a node and the user's remappings (`from:=to`).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Names {
    namespace: String,
    node: String,
    rules: Vec<(String, String)>,
}

impl Names {
    /// Creates the names of the node `node` in `namespace` (`/`, `/robot/front`) with `remappings`: `from:=to` for topics and
    /// services, `__node:=name` or `__name:=name` and `__ns:=/namespace` for the node itself. A rule `other:from:=to` applies to the
    /// node `other` only.
    ///
    /// # Errors
    /// `InvalidInput` for an invalid rule or name.
    pub fn new<S: AsRef<str>>(
        namespace: &str,
        node: &str,
        remappings: impl IntoIterator<Item = S>,
    ) -> Result<Self> {
        let mut names = Self { namespace: namespace.to_owned(), node: node.to_owned(), rules: Vec::new() };
        for rule in remappings {
            let rule = rule.as_ref();
            let (from, to) = rule.split_once(":=").ok_or_else(|| {
                Error::invalid_input(format!(
                    "{rule:?} is not a remapping; write from:=to, such as image:=/camera/image_raw"
                ))
            })?;
            let from = match from.split_once(':') {
                Some((only, from)) if only == node => from,
                Some(_) => continue,
                None => from,
            };
            match from {
                "__node" | "__name" => names.node = to.to_owned(),
                "__ns" => names.namespace = to.to_owned(),
                _ => names.rules.push((from.to_owned(), to.to_owned())),
            }
        }
        if !names.namespace.starts_with('/') {
            names.namespace.insert(0, '/');
        }
        while names.namespace.len() > 1 && names.namespace.ends_with('/') {
            names.namespace.pop();
        }
        check(&names.full())?;
        for at in 0..names.rules.len() {
            let (from, to) = &names.rules[at];
            let rule = (names.absolute(from)?, names.absolute(to)?);
            names.rules[at] = rule;
        }
        Ok(names)
    }

    /// Returns the namespace, such as `/robot`.
    pub fn namespace(&self) -> &str {
        &self.namespace
    }

    /// Returns the node's name without namespace.
    pub fn node(&self) -> &str {
        &self.node
    }

    /// Returns the node's name with its namespace.
    pub fn full(&self) -> String {
        self.in_namespace(&self.node)
    }

    /// Returns the absolute name of `name` (`/absolute`, `relative` to the namespace, `~/private` to the node) after the remappings.
    ///
    /// # Errors
    /// `InvalidInput` for an invalid name.
    pub fn resolve(&self, name: &str) -> Result<String> {
        let absolute = self.absolute(name)?;
        let rule = self.rules.iter().find(|(from, _)| *from == absolute);
        Ok(rule.map_or(absolute, |(_, to)| to.clone()))
    }

    fn absolute(&self, name: &str) -> Result<String> {
        let name = if let Some(private) = name.strip_prefix('~') {
            format!("{}/{}", self.full(), private.trim_start_matches('/'))
        } else if name.starts_with('/') {
            name.to_owned()
        } else {
            self.in_namespace(name)
        };
        check(&name)?;
        Ok(name)
    }

    fn in_namespace(&self, name: &str) -> String {
        format!("{}/{name}", self.namespace.trim_end_matches('/'))
    }
}

/// Checks an absolute name: words of letters, digits and `_` that do not begin with a digit, each after a `/`.
fn check(name: &str) -> Result<()> {
    let is_word = |word: &str| {
        word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && word.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            && !word.contains("__")
    };
    match name.strip_prefix('/') {
        Some(rest) if rest.split('/').all(is_word) => Ok(()),
        _ => Err(Error::invalid_input(format!(
            "{name:?} is not a ROS name; write words of letters, digits and single _, with / between"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_resolve_as_in_ros() {
        let rules = ["image:=/camera/image_raw", "~/boxes:=found", "other:image:=/no", "nanodet:mask:=/only"];
        let names = Names::new("/opendr", "nanodet", rules).unwrap();
        assert_eq!(names.full(), "/opendr/nanodet");
        for (name, wanted) in [
            ("image", "/camera/image_raw"),
            ("/opendr/image", "/camera/image_raw"),
            ("/image", "/image"),
            ("~/boxes", "/opendr/found"),
            ("~/poses", "/opendr/nanodet/poses"),
            ("mask", "/only"),
        ] {
            assert_eq!(names.resolve(name).unwrap(), wanted, "{name}");
        }
        let moved =
            Names::new("", "nanodet", ["__ns:=/robot/", "__node:=eyes", "image:=left/image"]).unwrap();
        assert_eq!(moved.full(), "/robot/eyes");
        assert_eq!(moved.resolve("image").unwrap(), "/robot/left/image");
        assert_eq!(Names::new("/", "a", [""; 0]).unwrap().resolve("b").unwrap(), "/b");
    }

    #[test]
    fn invalid_names_are_refused() {
        for name in ["", "9a", "a//b", "a-b", "/", "a__b", "ä"] {
            assert!(Names::new("/", "node", [""; 0]).unwrap().resolve(name).is_err(), "{name}");
            assert!(Names::new("/", name, [""; 0]).is_err(), "{name}");
        }
        assert!(Names::new("/", "node", ["a=b"]).is_err());
    }
}
