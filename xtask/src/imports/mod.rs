//! Imports between source files of one crate or package.

mod python;
mod rust;
mod use_tree;

pub use python::imports as of_python;
pub use rust::imports as of_crate;

/// An import of one file's item by another file.
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    /// Path of the importing file.
    pub from: String,
    /// Path of the file that defines the item.
    pub to: String,
    /// Line of the import in `from`.
    pub line: usize,
    /// Path or statement of the import, as it is written.
    pub path: String,
}

/// Two files that import each other, with the first import of each.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair(pub Import, pub Import);

/// Returns the pairs of files that import each other, ordered by path.
pub fn pairs(imports: &[Import]) -> Vec<Pair> {
    let mut pairs: Vec<Pair> = Vec::new();
    for import in imports.iter().filter(|import| import.from < import.to) {
        let is_known = |pair: &Pair| pair.0.from == import.from && pair.0.to == import.to;
        let back = imports.iter().find(|back| back.from == import.to && back.to == import.from);
        if let Some(back) = back.filter(|_| !pairs.iter().any(is_known)) {
            pairs.push(Pair(import.clone(), back.clone()));
        }
    }
    pairs.sort_by(|a, b| (&a.0.from, &a.0.to).cmp(&(&b.0.from, &b.0.to)));
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn import(from: &str, to: &str, line: usize) -> Import {
        Import { from: from.to_owned(), to: to.to_owned(), line, path: String::new() }
    }

    #[test]
    fn only_mutual_imports_are_pairs() {
        let (there, back) = (import("b", "c", 3), import("c", "b", 4));
        let imports =
            [import("a", "b", 1), import("b", "d", 2), back.clone(), there.clone(), import("b", "c", 5)];
        assert_eq!(pairs(&imports), [Pair(there, back)]);
        assert!(pairs(&imports[..2]).is_empty());
    }
}
