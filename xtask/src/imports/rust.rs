//! Imports between the files of a crate in Rust: `use` declarations and qualified paths, resolved to the file that defines the item.

use std::collections::{BTreeMap, BTreeSet};

use super::Import;
use super::use_tree::{Path, Use, names_of_use};
use crate::lexer::{Kind, Language, Token, tokens};

/// Returns the imports between the files of the crate with this root file, without code under `#[cfg(test)]`. `read` returns the text of
/// a file. A re-export (`pub use`) of an item of a submodule is no import unless the module's own code uses the item.
pub fn imports(root: &str, read: &dyn Fn(&str) -> Option<String>) -> Vec<Import> {
    let mut tree = Tree { read, modules: Vec::new(), macros: BTreeMap::new() };
    let folder = root.rsplit_once('/').map_or("", |(folder, _)| folder);
    tree.load(root, folder, None);
    let mut imports = Vec::new();
    for id in 0..tree.modules.len() {
        tree.imports_of(id, &mut imports);
    }
    imports
}

/// Keywords before the name of an item.
const ITEMS: [&str; 8] = ["fn", "struct", "enum", "union", "trait", "type", "const", "static"];

/// Other keywords with which an item begins.
const ITEM_BEGINNINGS: [&str; 9] =
    ["pub", "use", "mod", "impl", "unsafe", "async", "extern", "macro_rules", "let"];

struct Tree<'a> {
    read: &'a dyn Fn(&str) -> Option<String>,
    modules: Vec<Module>,
    /// Module of each macro by its name: exported macros have paths in the root.
    macros: BTreeMap<String, usize>,
}

#[derive(Default)]
struct Module {
    file: String,
    parent: Option<usize>,
    children: BTreeMap<String, usize>,
    /// Names of the items that it defines.
    items: BTreeSet<String>,
    uses: Vec<Use>,
    /// Qualified paths in its code.
    paths: Vec<Path>,
    /// Names in its code, outside of `use` declarations.
    names: BTreeSet<String>,
}

/// Result of the resolution of a path.
#[derive(Clone, Copy, PartialEq)]
enum Target {
    Module(usize),
    /// An item that this module defines.
    Item(usize),
    /// An item of another crate.
    External,
}

/// Names whose resolution is in progress.
type Visited = BTreeSet<(usize, String)>;

impl Tree<'_> {
    /// Adds the module of a file, whose submodules are files in `folder`.
    fn load(&mut self, file: &str, folder: &str, parent: Option<usize>) -> Option<usize> {
        let text = (self.read)(file)?;
        let mut tokens = tokens(&text, Language::Rust);
        tokens.retain(|token| matches!(token.kind, Kind::Name | Kind::Symbol));
        Some(self.add(file, folder, parent, &tokens))
    }

    fn add(&mut self, file: &str, folder: &str, parent: Option<usize>, tokens: &[Token]) -> usize {
        let id = self.modules.len();
        self.modules.push(Module { file: file.to_owned(), parent, ..Module::default() });
        self.scan(id, folder, tokens);
        id
    }

    /// Reads the tokens of a module.
    fn scan(&mut self, id: usize, folder: &str, tokens: &[Token]) {
        let (mut at, mut depth) = (0, 0);
        while let Some(token) = tokens.get(at) {
            let rest = &tokens[at..];
            let next = tokens.get(at + 1);
            let next_name = next.filter(|next| next.kind == Kind::Name).map(|next| next.text);
            at += 1;
            if token.is("#") && next.is_some_and(|next| next.is("[") || next.is("!")) {
                let length = attribute_length(rest);
                let is_inner = next.is_some_and(|next| next.is("!"));
                at += match is_for_tests(&rest[..length]) {
                    true if is_inner => return,
                    true => length - 1 + item_length(&rest[length..]),
                    false => length - 1,
                };
            } else if token.nesting() != 0 {
                depth += token.nesting();
            } else if token.is_name("use") && next.is_some_and(|next| !next.is("<")) {
                let before = at.checked_sub(2).and_then(|before| tokens.get(before));
                let is_public = before.is_some_and(|before| before.is_name("pub") || before.is(")"));
                self.modules[id].uses.extend(names_of_use(&rest[1..], is_public));
                at += rest.iter().position(|token| token.is(";")).unwrap_or(rest.len() - 1);
            } else if let (true, Some(name)) = (token.is_name("mod") && depth == 0, next_name) {
                at += self.submodule(id, folder, name, &rest[2..]) + 1;
            } else if token.is_name("macro_rules") {
                if let Some(name) = rest.get(2) {
                    self.modules[id].items.insert(name.text.to_owned());
                    self.macros.insert(name.text.to_owned(), id);
                }
            } else if token.kind == Kind::Name {
                let name =
                    if next_name == Some("mut") { rest.get(2).map(|name| name.text) } else { next_name };
                if depth == 0 && ITEMS.contains(&token.text) {
                    self.modules[id].items.extend(name.map(str::to_owned));
                }
                at += self.name(id, tokens, at - 1) - 1;
            }
        }
    }

    /// Adds the submodule whose tokens after `mod NAME` begin `rest`. Returns their number.
    fn submodule(&mut self, id: usize, folder: &str, name: &str, rest: &[Token]) -> usize {
        let name = name.trim_start_matches("r#");
        let folder = format!("{folder}/{name}");
        let (child, length) = match rest.first() {
            Some(token) if token.is("{") => {
                let length = group_length(rest);
                let file = self.modules[id].file.clone();
                (Some(self.add(&file, &folder, Some(id), &rest[1..length - 1])), length)
            }
            _ => {
                let files = [format!("{folder}.rs"), format!("{folder}/mod.rs")];
                (files.iter().find_map(|file| self.load(file, &folder, Some(id))), 1)
            }
        };
        if let Some(child) = child {
            self.modules[id].children.insert(name.to_owned(), child);
        }
        length
    }

    /// Records the name or path at a token. Returns the number of its tokens.
    fn name(&mut self, id: usize, tokens: &[Token], at: usize) -> usize {
        let module = &mut self.modules[id];
        let first = tokens[at];
        let before = at.checked_sub(1).and_then(|before| tokens.get(before));
        // The name after a dot is that of a field or method.
        if before.is_none_or(|before| !before.is(".")) && first.text != "_" {
            module.names.insert(first.text.to_owned());
        }
        let mut segments = vec![first.text.to_owned()];
        while let [separator, next, ..] = &tokens[at + 2 * segments.len() - 1..] {
            if !separator.is("::") || next.kind != Kind::Name {
                break;
            }
            segments.push(next.text.to_owned());
        }
        let length = 2 * segments.len() - 1;
        if segments.len() > 1 && before.is_none_or(|before| !before.is(".") && !before.is("::")) {
            module.paths.push(Path { segments, line: first.line });
        }
        length
    }

    /// Returns the targets of a name in a module.
    fn lookup(&self, id: usize, name: &str, visited: &mut Visited) -> Vec<Target> {
        let module = &self.modules[id];
        let mut targets: Vec<_> =
            module.children.get(name).map(|child| Target::Module(*child)).into_iter().collect();
        if module.items.contains(name) {
            targets.push(Target::Item(id));
        }
        if !visited.insert((id, name.to_owned())) {
            return targets;
        }
        for import in module.uses.iter().filter(|import| import.name == name) {
            targets.extend(self.resolve(id, &import.path.segments, visited));
        }
        if targets.is_empty() {
            for glob in module.uses.iter().filter(|import| import.name == "*") {
                targets.extend(self.lookup_in_glob(id, glob, name, visited));
            }
        }
        visited.remove(&(id, name.to_owned()));
        targets
    }

    fn lookup_in_glob(&self, id: usize, glob: &Use, name: &str, visited: &mut Visited) -> Vec<Target> {
        let from = self.resolve(id, &glob.path.segments, visited);
        from.into_iter()
            .flat_map(|target| match target {
                Target::Module(from) if from != id => self.lookup(from, name, visited),
                _ => Vec::new(),
            })
            .collect()
    }

    /// Returns the targets of a path in the code of a module. A path into a module of the crate whose name is not found there is an item
    /// that a macro defines.
    fn resolve(&self, id: usize, path: &[String], visited: &mut Visited) -> Vec<Target> {
        let mut current = id;
        let mut is_relative = true;
        for (number, segment) in path.iter().enumerate() {
            match segment.as_str() {
                "crate" => current = 0,
                "self" => (),
                "super" => current = self.modules[current].parent.unwrap_or(0),
                name => {
                    let targets = self.lookup(current, name, visited);
                    let submodule = targets.iter().find_map(|target| match target {
                        Target::Module(id) => Some(*id),
                        _ => None,
                    });
                    let is_last = number + 1 == path.len();
                    match submodule {
                        Some(submodule) if !is_last => current = submodule,
                        _ if !targets.is_empty() => return targets,
                        _ if is_relative => return vec![Target::External],
                        _ if visited.contains(&(current, name.to_owned())) => return Vec::new(),
                        _ => return vec![self.generated(current, name)],
                    }
                }
            }
            is_relative = false;
        }
        vec![Target::Module(current)]
    }

    /// Returns the target of a name that no item of a module has.
    fn generated(&self, id: usize, name: &str) -> Target {
        let has_external_names = self.modules[id].uses.iter().any(|import| {
            import.name == "*"
                && self.resolve(id, &import.path.segments, &mut Visited::new()).contains(&Target::External)
        });
        match self.macros.get(name) {
            Some(module) if id == 0 => Target::Item(*module),
            _ if has_external_names => Target::External,
            _ => Target::Item(id),
        }
    }

    fn is_below(&self, id: usize, ancestor: usize) -> bool {
        let mut parents = std::iter::successors(self.modules[id].parent, |id| self.modules[*id].parent);
        parents.any(|parent| parent == ancestor)
    }

    /// Appends the imports of a module.
    fn imports_of(&self, id: usize, imports: &mut Vec<Import>) {
        let module = &self.modules[id];
        let mut push = |target: Target, line: usize, path: String| {
            if let Target::Item(to) = target {
                let (from, to) = (module.file.clone(), self.modules[to].file.clone());
                if from != to {
                    imports.push(Import { from, to, line, path });
                }
            }
        };
        for import in &module.uses {
            let path = import.path.segments.join("::");
            let written = format!("{}use {path}", if import.is_public { "pub " } else { "" });
            let line = import.path.line;
            let is_used = |target: Target, name: &str| {
                let is_of_submodule = matches!(target, Target::Item(to) if self.is_below(to, id));
                !import.is_public || !is_of_submodule || module.names.contains(name)
            };
            for target in self.resolve(id, &import.path.segments, &mut Visited::new()) {
                if is_used(target, &import.name) {
                    push(target, line, written.clone());
                }
            }
            if import.name == "*" {
                let is_own = |name: &&String| {
                    module.items.contains(*name) || module.uses.iter().any(|other| other.name == **name)
                };
                for name in module.names.iter().filter(|name| !is_own(name)) {
                    for target in self.lookup_in_glob(id, import, name, &mut Visited::new()) {
                        push(target, line, format!("{written}::* ({name})"));
                    }
                }
            }
        }
        for path in &module.paths {
            let first = path.segments.first().map_or("", String::as_str);
            let starts_in_module = ["crate", "self", "super"].contains(&first)
                || self
                    .lookup(id, first, &mut Visited::new())
                    .iter()
                    .any(|target| matches!(target, Target::Module(_)));
            if starts_in_module {
                for target in self.resolve(id, &path.segments, &mut Visited::new()) {
                    push(target, path.line, path.segments.join("::"));
                }
            }
        }
    }
}

/// Returns the number of tokens of the attribute that begins a list of tokens.
fn attribute_length(tokens: &[Token]) -> usize {
    let bracket = tokens.iter().position(|token| token.is("[")).unwrap_or(0);
    bracket + group_length(&tokens[bracket..])
}

/// Returns whether an attribute is `#[cfg(test)]`, or another `cfg` that requires it.
fn is_for_tests(attribute: &[Token]) -> bool {
    let has = |name| attribute.iter().any(|token| token.is_name(name));
    has("cfg") && has("test") && !has("not") && !has("any")
}

/// Returns the number of tokens of the group in brackets that begins a list of tokens.
fn group_length(tokens: &[Token]) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate() {
        depth += token.nesting();
        if depth == 0 {
            return at + 1;
        }
    }
    tokens.len()
}

/// Returns the number of tokens of the item, field or statement that begins a list of tokens, with its attributes.
fn item_length(tokens: &[Token]) -> usize {
    let mut at = 0;
    while tokens.get(at).is_some_and(|token| token.is("#")) {
        at += attribute_length(&tokens[at..]);
    }
    let first = tokens.get(at).map_or("", |token| token.text);
    let is_use = tokens[at..].iter().take_while(|token| !token.is("{")).any(|token| token.is_name("use"));
    let is_item = ITEMS.contains(&first) || ITEM_BEGINNINGS.contains(&first);
    while let Some(token) = tokens.get(at) {
        if token.is(";") || token.is(",") && !is_item {
            return at + 1;
        }
        if token.nesting() < 0 {
            return at;
        }
        at += group_length(&tokens[at..]);
        if token.is("{") && !is_use {
            return at;
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the imports of a crate of these files, as `from -> to: path`, without the folder `src` and the ends of file names.
    fn of(files: &[(&str, &str)]) -> Vec<String> {
        let read = |wanted: &str| {
            files.iter().find(|(file, _)| format!("src/{file}") == wanted).map(|(_, text)| (*text).to_owned())
        };
        let short = |file: &str| file.trim_start_matches("src/").trim_end_matches(".rs").to_owned();
        let imports = imports("src/lib.rs", &read);
        imports
            .iter()
            .map(|import| format!("{} -> {}: {}", short(&import.from), short(&import.to), import.path))
            .collect()
    }

    #[test]
    fn imports_are_resolved_through_re_exports() {
        let files = [
            ("lib.rs", "mod a;\npub mod b;\npub use a::{A, C as D};"),
            ("a.rs", "use crate::b::B; pub struct A(B); pub struct C;"),
            ("b/mod.rs", "mod c; pub use self::c::*;"),
            ("b/c.rs", "use super::super::{A, D}; use std::fs::File; pub struct B;"),
        ];
        let expected =
            ["a -> b/c: use crate::b::B", "b/c -> a: use super::super::A", "b/c -> a: use super::super::D"];
        assert_eq!(of(&files), expected);
    }

    #[test]
    fn a_re_export_is_an_import_if_the_module_uses_the_item() {
        let child = ("a.rs", "pub struct A;");
        assert!(of(&[("lib.rs", "mod a; pub use a::A;"), child]).is_empty());
        assert_eq!(
            of(&[("lib.rs", "mod a; pub use a::A; fn f(_: A) {}"), child]),
            ["lib -> a: pub use a::A"]
        );
        assert_eq!(of(&[("lib.rs", "mod a; use a::A;"), child]), ["lib -> a: use a::A"]);
        assert!(of(&[("lib.rs", "mod a; pub use a::A; fn f(b: B) { b.A }"), child]).is_empty());
    }

    #[test]
    fn a_glob_imports_the_names_that_are_used() {
        let parent = ("lib.rs", "mod a; mod b; use b::B; pub struct L; pub enum Kind { One }");
        let child = ("b.rs", "pub struct B; pub struct C;");
        let with_b = of(&[parent, ("a.rs", "use super::*; fn f(_: B) {}"), child]);
        assert_eq!(with_b, ["lib -> b: use b::B", "a -> b: use super::* (B)"]);
        let with_l = of(&[parent, ("a.rs", "use super::*; fn f(_: L) {}"), child]);
        assert_eq!(with_l, ["lib -> b: use b::B", "a -> lib: use super::* (L)"]);
        let of_enum = of(&[parent, ("a.rs", "use super::Kind::*;"), child]);
        assert_eq!(of_enum, ["lib -> b: use b::B", "a -> lib: use super::Kind"]);
    }

    #[test]
    fn qualified_paths_are_imports() {
        let files = [
            ("lib.rs", "mod a; mod b; macro_rules! m { () => { $crate::a::f() } }"),
            ("a.rs", "pub fn f() { super::b::g::<u8>(0).a::<u8>() } newtype!(N);"),
            ("b.rs", "use crate::a; use std::fs; fn g() { a::f(); fs::read(); crate::m!(); crate::a::N(1) }"),
        ];
        let expected = [
            "lib -> a: crate::a::f",
            "a -> b: super::b::g",
            "b -> a: a::f",
            "b -> lib: crate::m",
            "b -> a: crate::a::N",
        ];
        assert_eq!(of(&files), expected);
    }

    #[test]
    fn code_for_tests_is_left_out() {
        let files = [
            (
                "lib.rs",
                "mod a; #[cfg(test)] mod tests; #[cfg(test)] use a::{A, B}; #[cfg(all(test, unix))] mod t { use crate::a::A; }
                 #[cfg(test)] #[allow(x)] fn f() { use a::A; } struct S { #[cfg(test)] field: a::A, other: u8 }
                 #[cfg(not(test))] fn g() { a::h() }",
            ),
            ("a.rs", "pub struct A; pub fn h() {}"),
            ("tests.rs", "use crate::a::A;"),
        ];
        assert_eq!(of(&files), ["lib -> a: a::h"]);
    }

    #[test]
    fn modules_in_a_file_belong_to_it() {
        let files = [
            ("lib.rs", "mod a; mod inner { pub use super::a::A; pub mod deep; pub struct I; } use inner::I;"),
            ("a.rs", "use crate::inner::{I, deep::D}; pub struct A;"),
            ("inner/deep.rs", "pub struct D; pub fn f() -> impl Sized + use<'a> { super::I }"),
        ];
        let expected = [
            "lib -> a: pub use super::a::A",
            "a -> lib: use crate::inner::I",
            "a -> inner/deep: use crate::inner::deep::D",
            "inner/deep -> lib: super::I",
        ];
        let mut found = of(&files);
        found.sort();
        let mut expected = expected.map(str::to_owned);
        expected.sort();
        assert_eq!(found, expected);
    }
}
