//! Serialiser of ROS 1's format.

use serde::Serialize;
use serde::ser::{
    Impossible, SerializeSeq, SerializeStruct, SerializeTuple, SerializeTupleStruct, Serializer,
};

use super::fields::{EMPTY_FIELD, HEADER};
use super::reason::Reason;

#[derive(Default)]
pub(super) struct Writer {
    bytes: Vec<u8>,
}

impl Writer {
    pub(super) fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    fn count(&mut self, count: usize) -> Result<(), Reason> {
        let count = u32::try_from(count).map_err(|_| Reason::Long)?;
        self.bytes.extend_from_slice(&count.to_le_bytes());
        Ok(())
    }
}

macro_rules! numbers {
    ($($method:ident $number:ty),*) => {$(
        fn $method(self, value: $number) -> Result<(), Reason> {
            self.bytes.extend_from_slice(&value.to_le_bytes());
            Ok(())
        }
    )*};
}

impl Serializer for &mut Writer {
    type Ok = ();
    type Error = Reason;
    type SerializeSeq = Self;
    type SerializeTuple = Self;
    type SerializeTupleStruct = Self;
    type SerializeTupleVariant = Impossible<(), Reason>;
    type SerializeMap = Impossible<(), Reason>;
    type SerializeStruct = Self;
    type SerializeStructVariant = Impossible<(), Reason>;

    numbers! {
        serialize_i8 i8, serialize_i16 i16, serialize_i32 i32, serialize_i64 i64, serialize_u8 u8, serialize_u16 u16,
        serialize_u32 u32, serialize_u64 u64, serialize_f32 f32, serialize_f64 f64
    }

    fn is_human_readable(&self) -> bool {
        false
    }

    fn serialize_bool(self, value: bool) -> Result<(), Reason> {
        self.serialize_u8(value.into())
    }

    fn serialize_char(self, _: char) -> Result<(), Reason> {
        Err(Reason::Unknown("wide character"))
    }

    fn serialize_str(self, text: &str) -> Result<(), Reason> {
        self.serialize_bytes(text.as_bytes())
    }

    fn serialize_bytes(self, bytes: &[u8]) -> Result<(), Reason> {
        self.count(bytes.len())?;
        self.bytes.extend_from_slice(bytes);
        Ok(())
    }

    fn serialize_none(self) -> Result<(), Reason> {
        Err(Reason::Unknown("optional field"))
    }

    fn serialize_some<T: Serialize + ?Sized>(self, _: &T) -> Result<(), Reason> {
        Err(Reason::Unknown("optional field"))
    }

    fn serialize_unit(self) -> Result<(), Reason> {
        Ok(())
    }

    fn serialize_unit_struct(self, _: &'static str) -> Result<(), Reason> {
        Ok(())
    }

    fn serialize_unit_variant(self, _: &'static str, _: u32, _: &'static str) -> Result<(), Reason> {
        Err(Reason::Unknown("enumeration"))
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<(), Reason> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: &T,
    ) -> Result<(), Reason> {
        Err(Reason::Unknown("enumeration"))
    }

    fn serialize_seq(self, length: Option<usize>) -> Result<Self, Reason> {
        self.count(length.ok_or(Reason::Unknown("array of unknown length"))?)?;
        Ok(self)
    }

    fn serialize_tuple(self, _: usize) -> Result<Self, Reason> {
        Ok(self)
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Self, Reason> {
        Ok(self)
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self::SerializeTupleVariant, Reason> {
        Err(Reason::Unknown("enumeration"))
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Self::SerializeMap, Reason> {
        Err(Reason::Unknown("map"))
    }

    fn serialize_struct(self, name: &'static str, _: usize) -> Result<Self, Reason> {
        if name == HEADER {
            self.serialize_u32(0)?;
        }
        Ok(self)
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self::SerializeStructVariant, Reason> {
        Err(Reason::Unknown("enumeration"))
    }
}

macro_rules! elements {
    ($($of:ident $method:ident),*) => {$(
        impl $of for &mut Writer {
            type Ok = ();
            type Error = Reason;

            fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Reason> {
                value.serialize(&mut **self)
            }

            fn end(self) -> Result<(), Reason> {
                Ok(())
            }
        }
    )*};
}

elements!(SerializeSeq serialize_element, SerializeTuple serialize_element, SerializeTupleStruct serialize_field);

impl SerializeStruct for &mut Writer {
    type Ok = ();
    type Error = Reason;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Result<(), Reason> {
        if key == EMPTY_FIELD { Ok(()) } else { value.serialize(&mut **self) }
    }

    fn end(self) -> Result<(), Reason> {
        Ok(())
    }
}
