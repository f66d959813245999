//! Reading of protocol buffer fields in place.

use opendr_engine::{Error, Result};

/// A field of a message: its number and value.
pub(crate) struct Field<'a> {
    pub(crate) number: u64,
    pub(crate) value: Value<'a>,
}

/// Value of a field, by wire type.
#[derive(Clone, Copy)]
pub(crate) enum Value<'a> {
    /// An integer, boolean or enumeration.
    Varint(u64),
    /// A string, message or packed array.
    Bytes(&'a [u8]),
    /// A 4- or 8-byte number; the checked parts of an ONNX model have none.
    Fixed,
}

/// An iterator over the fields of the message in `bytes`, in encoded order.
pub(crate) struct Fields<'a> {
    rest: &'a [u8],
}

impl<'a> Fields<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    fn field(&mut self) -> Option<Field<'a>> {
        let key = self.varint()?;
        let value = match key & 7 {
            0 => Value::Varint(self.varint()?),
            1 => self.take(8).map(|_| Value::Fixed)?,
            2 => {
                let length = self.varint()?;
                Value::Bytes(self.take(usize::try_from(length).ok()?)?)
            }
            5 => self.take(4).map(|_| Value::Fixed)?,
            _ => return None,
        };
        Some(Field { number: key >> 3, value })
    }

    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(count)?;
        self.rest = rest;
        Some(taken)
    }

    /// Reads the next varint, as in packed lists.
    pub(crate) fn varint(&mut self) -> Option<u64> {
        let mut value = 0_u64;
        for shift in (0..64).step_by(7) {
            let (&byte, rest) = self.rest.split_first()?;
            self.rest = rest;
            value |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
        None
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = Result<Field<'a>>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let field = self.field();
        if field.is_none() {
            self.rest = &[];
        }
        Some(field.ok_or_else(|| {
            Error::format("not an ONNX model, or a truncated one: a field is incomplete; copy or download the file again")
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_each_wire_type_and_stops_at_the_first_broken_field() {
        let bytes = [0x08, 0x96, 0x01, 0x12, 2, b'h', b'i', 0x1d, 1, 2, 3, 4, 0x22, 9, b'x'];
        let fields: Vec<_> = Fields::new(&bytes).collect();
        assert!(matches!(fields[0], Ok(Field { number: 1, value: Value::Varint(150) })));
        assert!(matches!(fields[1], Ok(Field { number: 2, value: Value::Bytes(b"hi") })));
        assert!(matches!(fields[2], Ok(Field { number: 3, value: Value::Fixed })));
        assert!(fields[3].is_err());
        assert_eq!(fields.len(), 4);
        assert!(
            Fields::new(&[0x08, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff])
                .next()
                .unwrap()
                .is_err()
        );
    }
}
