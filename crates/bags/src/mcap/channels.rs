//! Schemas and channels of an MCAP file.

use std::collections::HashMap;

use opendr_engine::{Error, Result};

use super::record::texts;
use crate::channel::{Channel, Definition, Encoding, Language, normal_type};
use crate::fields::Fields;
use crate::storage::Summary;

/// Schemas of the file, and channel indices by channel number.
#[derive(Default)]
pub(super) struct Channels {
    schemas: HashMap<u16, Schema>,
    indices: HashMap<u16, usize>,
}

struct Schema {
    name: String,
    definition: Option<Definition>,
}

impl Channels {
    /// Adds the schema of a record body; a record with a known number is ignored.
    pub fn add_schema(&mut self, body: &[u8]) -> Result<()> {
        let mut fields = Fields(body);
        let (number, name, encoding) = (fields.u16()?, fields.text()?, fields.text()?);
        let language = match encoding.as_str() {
            "ros1msg" | "ros2msg" => Some(Language::Msg),
            "ros2idl" | "omgidl" => Some(Language::Idl),
            _ => None,
        };
        let text = fields.sized()?;
        let definition = language.map(|language| {
            let text = String::from_utf8_lossy(text).into_owned();
            Definition { language, text }
        });
        self.schemas.entry(number).or_insert(Schema { name, definition });
        Ok(())
    }

    /// Adds the channel of a record body; a record with a known number is ignored.
    pub fn add_channel(&mut self, summary: &mut Summary, body: &[u8]) -> Result<()> {
        let mut fields = Fields(body);
        let (number, schema) = (fields.u16()?, fields.u16()?);
        if self.indices.contains_key(&number) {
            return Ok(());
        }
        let (topic, encoding) = (fields.text()?, fields.text()?);
        let mut metadata = texts(&mut fields)?;
        let encoding = Encoding::from_name(&encoding);
        let schema = self.schemas.get(&schema);
        let mut take = |key: &str| metadata.remove(key).filter(|value| !value.is_empty());
        let channel = Channel {
            topic,
            message_type: schema.map(|schema| normal_type(&schema.name, &encoding)).unwrap_or_default(),
            definition: schema.and_then(|schema| schema.definition.clone()),
            type_hash: if encoding == Encoding::Ros1 { take("md5sum") } else { take("topic_type_hash") },
            qos: take("offered_qos_profiles"),
            is_latching: take("latching").is_some_and(|latching| latching == "1" || latching == "true"),
            caller_id: take("callerid"),
            encoding,
        };
        self.indices.insert(number, summary.add(channel));
        Ok(())
    }

    pub fn index(&self, number: u16) -> Result<usize> {
        let unknown =
            || Error::format(format!("a message refers to channel {number}, which the file does not define"));
        self.indices.get(&number).copied().ok_or_else(unknown)
    }

    pub fn len(&self) -> usize {
        self.indices.len()
    }
}
