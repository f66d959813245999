//! All definitions of a folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt};

use crate::{BaseType, Definition, Service, TypeName};

/// Definitions of a folder with files `PACKAGE/msg/NAME.msg` and `PACKAGE/srv/NAME.srv`.
#[derive(Debug, Clone, Default)]
pub struct Library {
    messages: BTreeMap<TypeName, Definition>,
    services: BTreeMap<TypeName, Service>,
}

impl Library {
    /// Reads every definition below `folder`.
    ///
    /// # Errors
    /// `Io`, `Format` as [`Definition::parse`], `NotFound` for an undefined type.
    pub fn open(folder: &Path) -> Result<Self> {
        let mut library = Self::default();
        library.read(folder)?;
        library.check()?;
        Ok(library)
    }

    /// Returns a copy in which the definitions below `folder` replace these, for the differences of ROS 1.
    ///
    /// # Errors
    /// As [`Library::open`].
    pub fn with_overrides(&self, folder: &Path) -> Result<Self> {
        let mut library = self.clone();
        library.read(folder)?;
        library.check()?;
        Ok(library)
    }

    /// Returns all messages, by name.
    pub fn messages(&self) -> impl Iterator<Item = &Definition> {
        self.messages.values()
    }

    /// Returns all services, by name.
    pub fn services(&self) -> impl Iterator<Item = &Service> {
        self.services.values()
    }

    /// Returns the definition of a name.
    ///
    /// # Errors
    /// `NotFound`.
    pub fn get(&self, name: &TypeName) -> Result<&Definition> {
        self.messages.get(name).ok_or_else(|| {
            Error::not_found(format!("no definition of {name}; add {}/msg/{}.msg", name.package, name.name))
        })
    }

    /// Returns the messages that `definition` contains, directly or indirectly, by name and without itself.
    ///
    /// # Errors
    /// `NotFound`.
    pub fn dependencies(&self, definition: &Definition) -> Result<Vec<&Definition>> {
        let mut found = BTreeMap::new();
        let mut open: Vec<&Definition> = vec![definition];
        while let Some(next) = open.pop() {
            for used in used_types(next) {
                if !found.contains_key(used) {
                    let definition = self.get(used)?;
                    found.insert(used, definition);
                    open.push(definition);
                }
            }
        }
        Ok(found.into_values().collect())
    }

    fn read(&mut self, folder: &Path) -> Result<()> {
        for package in entries(folder)?.into_iter().filter(|path| path.is_dir()) {
            let package_name = file_name(&package);
            for file in entries(&package.join("msg"))? {
                let name = TypeName::new(&package_name, stem(&file));
                let definition = Definition::parse(name.clone(), &read_text(&file)?)?;
                self.messages.insert(name, definition);
            }
            for file in entries(&package.join("srv"))? {
                let name = TypeName::new(&package_name, stem(&file));
                self.services.insert(name.clone(), Service::parse(name, &read_text(&file)?)?);
            }
        }
        Ok(())
    }

    fn check(&self) -> Result<()> {
        let parts = self.services.values().flat_map(|service| [&service.request, &service.response]);
        for definition in self.messages.values().chain(parts) {
            for used in used_types(definition) {
                self.get(used).context(|| definition.name.to_string())?;
            }
        }
        Ok(())
    }
}

fn used_types(definition: &Definition) -> impl Iterator<Item = &TypeName> {
    definition.fields.iter().filter_map(|field| match &field.field_type.base {
        BaseType::Message(name) => Some(name),
        BaseType::Primitive(_) => None,
    })
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let context = || format!("reading {}", folder.display());
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(Error::from).context(context)? {
        paths.push(entry.map_err(Error::from).context(context)?.path());
    }
    paths.sort();
    Ok(paths)
}

fn read_text(file: &Path) -> Result<String> {
    std::fs::read_to_string(file).map_err(Error::from).context(|| format!("reading {}", file.display()))
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

fn stem(path: &Path) -> String {
    path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}
