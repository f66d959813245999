//! The named inputs of a learner.

use smallvec::SmallVec;

use crate::{Datum, Error, Header, Result, Value, ValueRef, ValueType};

/// One named input: a Python argument, a command-line flag, a field of a C struct, a ROS topic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Port {
    /// Its name on every surface.
    pub name: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// The type it takes.
    pub value_type: ValueType,
    /// Whether it may be left out.
    pub optional: bool,
    /// Whether it is given once per stream, with its first call, and kept in the state.
    pub init: bool,
}

/// What a learner takes: a reference to one datum, or a `#[derive(Inputs)]` struct of references.
pub trait Inputs<'a>: Sized {
    /// The table of ports.
    const PORTS: &'static [Port];

    /// Picks the ports out of named values.
    ///
    /// # Errors
    /// `InvalidInput` when a port is missing or of another type.
    fn from_ports(ports: &Ports<'a>) -> Result<Self>;

    /// Stamp and frame of the first port; the targets carry them.
    fn header(&self) -> &Header;
}

impl<'a, T: Datum> Inputs<'a> for &'a T {
    const PORTS: &'static [Port] =
        &[Port { name: T::TYPE.port(), doc: "", value_type: T::TYPE, optional: false, init: false }];

    fn from_ports(ports: &Ports<'a>) -> Result<Self> {
        ports.required(T::TYPE.port())
    }

    fn header(&self) -> &Header {
        Datum::header(*self)
    }
}

/// Named values on their way from a surface to a learner.
#[derive(Debug, Clone, Default)]
pub struct Ports<'a> {
    values: SmallVec<[(&'a str, ValueRef<'a>); 4]>,
}

impl<'a> Ports<'a> {
    /// The only port of a learner with one input.
    pub fn one(value: impl Into<ValueRef<'a>>) -> Self {
        let value = value.into();
        Self::default().with(value.value_type().port(), value)
    }

    /// The data of a sample as the ports of a learner: each port takes the first datum of its type that none before it took, and
    /// is left out where there is none; what is given once a stream is not in samples. Where no type fits, they are in
    /// the order of the ports, so that the learner says what it wants.
    pub fn of_sample(table: &'a [Port], data: &'a [Value]) -> Self {
        let mut is_taken: SmallVec<[bool; 4]> = data.iter().map(|_| false).collect();
        let mut ports = Self::default();
        for port in table.iter().filter(|port| !port.init) {
            let fits = |(at, value): &(usize, &Value)| {
                !is_taken[*at] && value.as_value_ref().value_type() == port.value_type
            };
            if let Some((at, value)) = data.iter().enumerate().find(fits) {
                is_taken[at] = true;
                ports = ports.with(port.name, value);
            }
        }
        if ports.values.is_empty() {
            return table.iter().zip(data).fold(ports, |ports, (port, value)| ports.with(port.name, value));
        }
        ports
    }

    /// Adds a port.
    #[must_use]
    pub fn with(mut self, name: &'a str, value: impl Into<ValueRef<'a>>) -> Self {
        self.values.push((name, value.into()));
        self
    }

    /// The value of a port.
    pub fn get(&self, name: &str) -> Option<ValueRef<'a>> {
        self.values.iter().find(|(port, _)| *port == name).map(|(_, value)| *value)
    }

    /// The value of a port that must be there.
    ///
    /// # Errors
    /// `InvalidInput` when it is missing or of another type.
    pub fn required<T: Datum>(&self, name: &str) -> Result<&'a T> {
        self.optional(name)?.ok_or_else(|| {
            Error::invalid_input(format!("input {name:?} ({}) is missing; give it", T::TYPE.name()))
        })
    }

    /// The value of a port that may be left out.
    ///
    /// # Errors
    /// `InvalidInput` when it is of another type.
    pub fn optional<T: Datum>(&self, name: &str) -> Result<Option<&'a T>> {
        let Some(value) = self.get(name) else { return Ok(None) };
        T::from_value_ref(value).map(Some).ok_or_else(|| {
            let (wanted, given) = (T::TYPE.name(), value.value_type().name());
            Error::invalid_input(format!("input {name:?} takes {wanted}, not {given}"))
        })
    }

    /// Checks the names against the table of a learner.
    ///
    /// # Errors
    /// `InvalidInput` for a port that the learner does not have.
    pub fn check_names(&self, table: &[Port]) -> Result<()> {
        for (name, _) in &self.values {
            if !table.iter().any(|port| port.name == *name) {
                let names: Vec<_> = table.iter().map(|port| port.name).collect();
                return Err(Error::invalid_input(format!(
                    "no input {name:?}; there are {}",
                    names.join(", ")
                )));
            }
        }
        Ok(())
    }

    /// Checks the names, and that an init port is given when its stream begins.
    ///
    /// # Errors
    /// `InvalidInput` for a port that the learner does not have, or a missing init port.
    pub(crate) fn check(&self, table: &[Port], begins: bool) -> Result<()> {
        self.check_names(table)?;
        match table.iter().find(|port| begins && port.init && self.get(port.name).is_none()) {
            Some(port) => Err(Error::invalid_input(format!(
                "input {:?} ({}) must be given with the first call of a stream; give it, or reset and begin again",
                port.name,
                port.value_type.name()
            ))),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::{BoundingBoxList, Category, PoseList};

    const fn port(name: &'static str, value_type: ValueType, init: bool) -> Port {
        Port { name, doc: "", value_type, optional: true, init }
    }

    static TABLE: [Port; 4] = [
        port("begin", ValueType::BoundingBoxList, true),
        port("left", ValueType::BoundingBoxList, false),
        port("right", ValueType::BoundingBoxList, false),
        port("poses", ValueType::PoseList, false),
    ];

    #[test]
    fn samples_meet_ports_by_type() {
        let data: [Value; 3] =
            [PoseList::default().into(), Category::default().into(), BoundingBoxList::default().into()];
        let ports = Ports::of_sample(&TABLE, &data);
        let names: Vec<_> = ports.values.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["left", "poses"]);
        assert_eq!(ports.get("left").unwrap().value_type(), ValueType::BoundingBoxList);
        let ports = Ports::of_sample(&TABLE, &data[1..2]);
        assert!(ports.get("begin").is_some(), "as they stand");
        assert!(Ports::of_sample(&TABLE, &[]).values.is_empty());
    }
}
