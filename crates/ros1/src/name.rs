//! Names of the ROS graph: validation, and resolution of relative, private and remapped names.
//!
//! Source: <https://wiki.ros.org/Names>, and rospy's `rosgraph.names` where the page is silent.

use std::collections::BTreeMap;

use opendr_engine::{Error, Result};

/// Name, namespace and remappings of one node.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Names {
    node: String,
    remappings: BTreeMap<String, String>,
}

impl Names {
    /// Creates the names of node `name` (without slashes) in `namespace`, with remappings `from`, `to` in any form.
    ///
    /// # Errors
    /// `InvalidParam` for an invalid name.
    pub fn new(name: &str, namespace: &str, remappings: &[(String, String)]) -> Result<Self> {
        check_node_name(name)?;
        let namespace = canonical(&format!("/{namespace}"));
        check_graph_name(&namespace)?;
        let node = canonical(&format!("{namespace}/{name}"));
        let mut names = Self { node, remappings: BTreeMap::new() };
        for (from, to) in remappings {
            let rule = (names.resolve_unmapped(from)?, names.resolve_unmapped(to)?);
            names.remappings.extend([rule]);
        }
        Ok(names)
    }

    /// Returns the node's full name, such as `/drone/camera`.
    pub fn node(&self) -> &str {
        &self.node
    }

    /// Resolves `name` to its full name after remapping.
    ///
    /// # Errors
    /// `InvalidParam` for an invalid name.
    pub fn resolve(&self, name: &str) -> Result<String> {
        let full = self.resolve_unmapped(name)?;
        Ok(self.remappings.get(&full).cloned().unwrap_or(full))
    }

    fn resolve_unmapped(&self, name: &str) -> Result<String> {
        check_graph_name(name)?;
        let full = if name.starts_with('/') {
            name.to_owned()
        } else if let Some(private) = name.strip_prefix('~') {
            format!("{}/{private}", self.node)
        } else {
            format!("{}/{name}", parent(&self.node))
        };
        Ok(canonical(&full))
    }
}

/// Returns the namespace of `name`, without a trailing slash: `/a` for `/a/b`, empty for `/a`.
pub(crate) fn parent(name: &str) -> &str {
    name.rsplit_once('/').map_or("", |(parent, _)| parent)
}

/// Normalises slashes: one between parts, none at the end.
pub(crate) fn canonical(name: &str) -> String {
    let parts: Vec<&str> = name.split('/').filter(|part| !part.is_empty()).collect();
    let start = if name.starts_with('/') { "/" } else { "" };
    format!("{start}{}", parts.join("/"))
}

fn check_node_name(name: &str) -> Result<()> {
    let mut letters = name.chars();
    let starts = letters.next().is_some_and(|first| first.is_ascii_alphabetic());
    if starts && letters.all(|letter| letter.is_ascii_alphanumeric() || letter == '_') {
        return Ok(());
    }
    Err(Error::invalid_param(format!(
        "{name:.80?} is not a name of a ROS node; use a letter, then letters, digits and _, no slashes"
    )))
}

fn check_graph_name(name: &str) -> Result<()> {
    let mut letters = name.chars();
    let starts =
        letters.next().is_some_and(|first| first.is_ascii_alphabetic() || first == '/' || first == '~');
    let goes_on = letters.all(|letter| letter.is_ascii_alphanumeric() || letter == '_' || letter == '/');
    if starts && goes_on && !name.contains("//") {
        return Ok(());
    }
    Err(Error::invalid_param(format!(
        "{name:.80?} is not a ROS name; start with a letter, / or ~ and continue with letters, digits, _ and /"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(remappings: &[(&str, &str)]) -> Names {
        let owned: Vec<_> = remappings.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect();
        Names::new("camera", "drone/front/", &owned).unwrap()
    }

    #[test]
    fn names_resolve_as_in_the_wiki() {
        let names = names(&[]);
        assert_eq!(names.node(), "/drone/front/camera");
        for (name, full) in [
            ("image", "/drone/front/image"),
            ("image/raw/", "/drone/front/image/raw"),
            ("/image", "/image"),
            ("~image", "/drone/front/camera/image"),
            ("~/image", "/drone/front/camera/image"),
        ] {
            assert_eq!(names.resolve(name).unwrap(), full, "{name}");
        }
        assert_eq!(Names::new("a", "", &[]).unwrap().resolve("b").unwrap(), "/b");
        assert_eq!(Names::new("a", "/", &[]).unwrap().resolve("~b").unwrap(), "/a/b");
    }

    #[test]
    fn remappings_are_resolved_on_both_sides() {
        let names = names(&[("image", "/usb/image"), ("~rate", "rate"), ("/x", "~y")]);
        assert_eq!(names.resolve("image").unwrap(), "/usb/image");
        assert_eq!(names.resolve("/drone/front/image").unwrap(), "/usb/image");
        assert_eq!(names.resolve("~rate").unwrap(), "/drone/front/rate");
        assert_eq!(names.resolve("/x").unwrap(), "/drone/front/camera/y");
        assert_eq!(names.resolve("/usb/image").unwrap(), "/usb/image");
    }

    #[test]
    fn bad_names_are_refused() {
        let names = names(&[]);
        for name in ["", "1a", "a-b", "a//b", "a b", "é", "a~b", "_a"] {
            assert!(names.resolve(name).is_err(), "{name}");
        }
        for name in ["", "a/b", "/a", "1a", "~a", "a.b"] {
            assert!(Names::new(name, "", &[]).is_err(), "{name}");
        }
        assert!(Names::new("a", "b c", &[]).is_err());
    }
}
