//! The named inputs of a learner.

use smallvec::SmallVec;

use crate::{Datum, Error, Header, Result, Value, ValueRef, ValueType};

/// A named input of a learner: a Python argument, a command-line flag, a field of a C struct, a ROS topic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Port {
    /// Name, the same on every surface.
    pub name: &'static str,
    /// Description.
    pub doc: &'static str,
    /// Type of the value.
    pub value_type: ValueType,
    /// Whether the input may be omitted.
    pub optional: bool,
    /// Whether the input is passed once per stream, with the first call, and kept in the state.
    pub init: bool,
}

/// The input of a learner: a reference to one datum, or a `#[derive(Inputs)]` struct of references.
pub trait Inputs<'a>: Sized {
    /// Table of the ports.
    const PORTS: &'static [Port];

    /// Creates the input from named values.
    ///
    /// # Errors
    /// Returns `InvalidInput` if a port is missing or of another type.
    fn from_ports(ports: &Ports<'a>) -> Result<Self>;

    /// Returns stamp and frame of the first port; the targets get the same.
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

/// Named input values, as a surface passes them to a learner.
#[derive(Debug, Clone, Default)]
pub struct Ports<'a> {
    values: SmallVec<[(&'a str, ValueRef<'a>); 4]>,
}

impl<'a> Ports<'a> {
    /// Creates the ports of a learner with one input.
    pub fn one(value: impl Into<ValueRef<'a>>) -> Self {
        let value = value.into();
        Self::default().with(value.value_type().port(), value)
    }

    /// Assigns the data of a sample to the ports of a learner.
    ///
    /// Each port gets the first datum of its type that no port before it has, and none if there is none left. Init ports are
    /// skipped. If no type fits, data are assigned in the order of the ports, so that the learner reports the expected types.
    pub fn of_sample(table: &'a [Port], data: &'a [Value]) -> Self {
        let mut is_assigned: SmallVec<[bool; 4]> = data.iter().map(|_| false).collect();
        let mut ports = Self::default();
        for port in table.iter().filter(|port| !port.init) {
            let fits = |(at, value): &(usize, &Value)| {
                !is_assigned[*at] && value.as_value_ref().value_type() == port.value_type
            };
            if let Some((at, value)) = data.iter().enumerate().find(fits) {
                is_assigned[at] = true;
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

    /// Returns the value of a port.
    pub fn get(&self, name: &str) -> Option<ValueRef<'a>> {
        self.values.iter().find(|(port, _)| *port == name).map(|(_, value)| *value)
    }

    /// Returns the value of a required port.
    ///
    /// # Errors
    /// Returns `InvalidInput` if it is missing or of another type.
    pub fn required<T: Datum>(&self, name: &str) -> Result<&'a T> {
        self.optional(name)?.ok_or_else(|| {
            Error::invalid_input(format!("input {name:?} ({}) is missing; pass it", T::TYPE.name()))
        })
    }

    /// Returns the value of an optional port.
    ///
    /// # Errors
    /// Returns `InvalidInput` if it is of another type.
    pub fn optional<T: Datum>(&self, name: &str) -> Result<Option<&'a T>> {
        let Some(value) = self.get(name) else { return Ok(None) };
        T::from_value_ref(value).map(Some).ok_or_else(|| {
            let (expected, given) = (T::TYPE.name(), value.value_type().name());
            Error::invalid_input(format!("input {name:?} takes {expected}, not {given}"))
        })
    }

    /// Checks the names against the ports of a learner.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a port that the learner does not have.
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

    /// Checks the names, and that the init ports are given if the stream begins.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a port that the learner does not have, or a missing init port.
    pub(crate) fn check(&self, table: &[Port], begins: bool) -> Result<()> {
        self.check_names(table)?;
        match table.iter().find(|port| begins && port.init && self.get(port.name).is_none()) {
            Some(port) => Err(Error::invalid_input(format!(
                "input {:?} ({}) must be passed with the first call of a stream; pass it, or reset the stream",
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
    fn samples_are_assigned_to_ports_by_type() {
        let data: [Value; 3] =
            [PoseList::default().into(), Category::default().into(), BoundingBoxList::default().into()];
        let ports = Ports::of_sample(&TABLE, &data);
        let names: Vec<_> = ports.values.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["left", "poses"]);
        assert_eq!(ports.get("left").unwrap().value_type(), ValueType::BoundingBoxList);
        let ports = Ports::of_sample(&TABLE, &data[1..2]);
        assert!(ports.get("begin").is_some(), "in the order of the ports");
        assert!(Ports::of_sample(&TABLE, &[]).values.is_empty());
    }
}
