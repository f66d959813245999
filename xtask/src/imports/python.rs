//! Imports between the modules of a Python package, resolved to the file that defines the name.

use std::collections::{BTreeMap, BTreeSet};

use super::Import;
use crate::lexer::{Kind, Language, Token, tokens};

/// Returns the imports between the modules of packages in a folder that run when a module is imported: not those of functions and those
/// for type checkers. `files` are paths with their texts. A name that a package imports from its own modules is an import only if the
/// code of its `__init__.py` uses it.
pub fn imports(folder: &str, files: &[(String, String)]) -> Vec<Import> {
    let modules: BTreeMap<String, Module> = files
        .iter()
        .filter_map(|(file, text)| Some((name_of(folder, file)?, Module::read(file, text))))
        .collect();
    let mut imports = Vec::new();
    for (name, module) in &modules {
        for statement in &module.statements {
            let source = module.absolute(name, &statement.module);
            let home = home(&modules, &source, statement.name.as_deref(), &mut Vec::new());
            let Some((home, to)) = home.and_then(|home| Some((home, modules.get(home)?))) else { continue };
            let is_re_export = module.is_package && home.starts_with(&format!("{name}."));
            let is_own = module.names.contains(&statement.alias);
            if to.file != module.file && (!is_re_export || is_own) {
                imports.push(Import {
                    from: module.file.clone(),
                    to: to.file.clone(),
                    line: statement.line,
                    path: statement.to_string(),
                });
            }
        }
    }
    imports
}

/// A module of a package.
struct Module {
    file: String,
    is_package: bool,
    statements: Vec<Statement>,
    /// Names in its code, outside of import statements.
    names: BTreeSet<String>,
}

/// One name of an import statement.
struct Statement {
    /// Module that is named, with leading dots if it is relative.
    module: String,
    /// Name out of it; none for `import module`.
    name: Option<String>,
    /// Name in the importing module.
    alias: String,
    line: usize,
}

impl std::fmt::Display for Statement {
    fn fmt(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        match &self.name {
            Some(name) => write!(formatter, "from {} import {name}", self.module),
            None => write!(formatter, "import {}", self.module),
        }
    }
}

impl Module {
    fn read(file: &str, text: &str) -> Self {
        let mut module = Self {
            file: file.to_owned(),
            is_package: file.ends_with("/__init__.py"),
            statements: Vec::new(),
            names: BTreeSet::new(),
        };
        // Indentation of the block that does not run on import.
        let mut skipped: Option<usize> = None;
        for line in logical_lines(text) {
            let first = line[0];
            let is_import = first.is_name("import") || first.is_name("from");
            if !is_import {
                module.names.extend(
                    line.iter().filter(|token| token.kind == Kind::Name).map(|token| token.text.to_owned()),
                );
            }
            skipped = skipped.filter(|indentation| first.column > *indentation);
            let has = |name| line.iter().any(|token| token.is_name(name));
            let is_function = first.is_name("def") || first.is_name("async") && has("def");
            let is_for_checkers = first.is_name("if") && has("TYPE_CHECKING") && !has("not");
            match skipped {
                None if is_function || is_for_checkers => skipped = Some(first.column),
                None if is_import => statements(&line, &mut module.statements),
                _ => (),
            }
        }
        module
    }

    /// Returns the full name of a module that is named in the module `name`.
    fn absolute(&self, name: &str, module: &str) -> String {
        let rest = module.trim_start_matches('.');
        let dots = module.len() - rest.len();
        if dots == 0 {
            return module.to_owned();
        }
        let up = if self.is_package { dots - 1 } else { dots };
        let package = (0..up).fold(name, |name, _| name.rsplit_once('.').map_or("", |(package, _)| package));
        format!("{package}.{rest}").trim_matches('.').to_owned()
    }
}

/// Returns the module that a name comes from: a submodule of this name, or the module from which `module` imports it, or `module`.
fn home<'a>(
    modules: &'a BTreeMap<String, Module>,
    module: &str,
    name: Option<&str>,
    visited: &mut Vec<String>,
) -> Option<&'a str> {
    let (key, source) = modules.get_key_value(module)?;
    let Some(name) = name else { return Some(key) };
    if let Some((submodule, _)) = modules.get_key_value(&format!("{module}.{name}")) {
        return Some(submodule);
    }
    let place = format!("{module}:{name}");
    if visited.contains(&place) {
        return Some(key);
    }
    visited.push(place);
    let imported = source.statements.iter().filter(|statement| statement.name.is_some());
    let mut imported =
        imported.filter(|statement| statement.alias == name || statement.name.as_deref() == Some("*"));
    let found = imported.find_map(|statement| {
        let star = statement.alias == "*";
        let from = source.absolute(module, &statement.module);
        if star {
            let has_name = modules.get(&from).is_some_and(|from| from.names.contains(name));
            return has_name.then(|| home(modules, &from, Some(name), visited)).flatten();
        }
        home(modules, &from, statement.name.as_deref(), visited)
    });
    found.or(Some(key))
}

/// Returns the name of the module in a file below a folder.
fn name_of(folder: &str, file: &str) -> Option<String> {
    let path = file.strip_prefix(folder)?.trim_start_matches('/').strip_suffix(".py")?;
    Some(path.trim_end_matches("/__init__").replace('/', "."))
}

/// Returns the tokens of each logical line: lines in brackets and after backslashes continue.
fn logical_lines(text: &str) -> Vec<Vec<Token<'_>>> {
    let mut lines: Vec<Vec<Token>> = Vec::new();
    let (mut depth, mut last_line, mut continues) = (0, 0, false);
    for token in tokens(text, Language::Python) {
        if token.kind == Kind::Comment {
            continue;
        }
        match lines.last_mut() {
            Some(line) if depth > 0 || continues || token.line == last_line => line.push(token),
            _ => lines.push(vec![token]),
        }
        depth += token.nesting();
        continues = token.is("\\");
        last_line = token.line + token.text.matches('\n').count();
    }
    lines
}

/// Appends the names of an import statement.
fn statements(line: &[Token], found: &mut Vec<Statement>) {
    let is_from = line[0].is_name("from");
    let is_list = |token: &Token| token.kind == Kind::Name || token.is(".") || token.is(",") || token.is("*");
    let mut parts = line[1..].split(|token| token.is_name("import"));
    let module: String = if is_from {
        parts.next().into_iter().flatten().map(|token| token.text).collect()
    } else {
        String::new()
    };
    let list: Vec<_> = parts.flatten().filter(|token| is_list(token)).collect();
    for words in list.split(|token| token.is(",")) {
        let (written, alias) = match words {
            [] => continue,
            [written @ .., keyword, alias] if keyword.is_name("as") => (written, Some(alias.text)),
            written => (written, None),
        };
        let written: String = written.iter().map(|token| token.text).collect();
        let first = written.split('.').next().unwrap_or_default();
        let alias = alias.unwrap_or(first).to_owned();
        let line = words[0].line;
        found.push(match is_from {
            true => Statement { module: module.clone(), name: Some(written), alias, line },
            false => Statement { module: written, name: None, alias, line },
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(files: &[(&str, &str)]) -> Vec<String> {
        let files: Vec<_> =
            files.iter().map(|(file, text)| (format!("python/{file}"), (*text).to_owned())).collect();
        let short = |file: &str| file.trim_start_matches("python/").to_owned();
        let imports = imports("python", &files);
        imports
            .iter()
            .map(|import| {
                format!("{}:{} -> {}: {}", short(&import.from), import.line, short(&import.to), import.path)
            })
            .collect()
    }

    #[test]
    fn every_form_of_import_is_resolved() {
        let files = [
            ("p/__init__.py", ""),
            (
                "p/a.py",
                "import os, p.b as b\nfrom p import (\n    b,\n    c as d,\n)\nfrom . import \\\n    b\nfrom .q.d import D\n",
            ),
            (
                "p/b.py",
                "\"\"\"\nimport p.a\n\"\"\"\ntry:\n    from .q import D\nexcept ImportError:\n    pass\n",
            ),
            ("p/c.py", "x = y = 0\n"),
            ("p/e.py", "from p.q import x"),
            ("p/q/__init__.py", "from ..c import *\nfrom .d import D\n"),
            ("p/q/d.py", ""),
        ];
        let expected = [
            "p/a.py:1 -> p/b.py: import p.b",
            "p/a.py:3 -> p/b.py: from p import b",
            "p/a.py:4 -> p/c.py: from p import c",
            "p/a.py:7 -> p/b.py: from . import b",
            "p/a.py:8 -> p/q/d.py: from .q.d import D",
            "p/b.py:5 -> p/q/d.py: from .q import D",
            "p/e.py:1 -> p/c.py: from p.q import x",
            "p/q/__init__.py:1 -> p/c.py: from ..c import *",
        ];
        assert_eq!(of(&files), expected);
    }

    #[test]
    fn imports_that_do_not_run_on_import_are_left_out() {
        let source = "if TYPE_CHECKING:\n    from p.b import B\nelse:\n    import p.c\n\ndef f():\n    if x:\n        import p.b\n\n\
                      async def g():\n    import p.b\n\nclass C:\n    import p.d\n    def h(self):\n        import p.b\n";
        let files = [("p/a.py", source), ("p/b.py", ""), ("p/c.py", ""), ("p/d.py", "")];
        assert_eq!(of(&files), ["p/a.py:4 -> p/c.py: import p.c", "p/a.py:14 -> p/d.py: import p.d"]);
    }

    #[test]
    fn a_re_export_is_an_import_if_the_package_uses_the_name() {
        let child = ("p/a.py", "from p import B\n");
        let files = |init| [("p/__init__.py", init), child, ("p/b.py", "")];
        assert_eq!(
            of(&files("from p.b import B\n__all__ = [\"B\"]\n")),
            ["p/a.py:1 -> p/b.py: from p import B"]
        );
        assert_eq!(of(&files("from p.b import B\nx = B()\n")).len(), 2);
    }
}
