//! Prints a recording as lines of JSON: its format, channels and messages.
//!
//! `cargo run -p opendr-bags --example bag_dump -- RECORDING [--topic TOPIC]... [--start NS] [--end NS] [--count]`
//!
//! The content of a message is printed as its SHA-256. With `--count`, all messages are read and only their number
//! and size printed.

use std::io::{BufWriter, Write, stdout};

use opendr_bags::{Bag, Channel, Encoding, Language, Selection};
use opendr_engine::{Error, Result};
use serde_json::json;
use sha2::{Digest, Sha256};

fn main() -> Result<()> {
    let mut selection = Selection::default();
    let (mut path, mut is_counting) = (None, false);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or_else(|| Error::invalid_param("a value is missing"));
        let number = |text: String| text.parse().map_err(|_| Error::invalid_param(text));
        match argument.as_str() {
            "--topic" => selection.topics.get_or_insert_default().push(value()?),
            "--start" => selection.start_ns = Some(number(value()?)?),
            "--end" => selection.end_ns = Some(number(value()?)?),
            "--file-order" => selection.in_file_order = true,
            "--count" => is_counting = true,
            _ => path = Some(argument),
        }
    }
    let bag = Bag::open(path.ok_or_else(|| Error::invalid_param("name a recording"))?)?;
    let mut out = BufWriter::new(stdout().lock());
    let head = json!({
        "format": bag.format().name(), "messages": bag.message_count(), "counts": bag.message_counts(),
        "start_ns": bag.start_ns(), "end_ns": bag.end_ns(), "is_complete": bag.is_complete(),
        "channels": bag.channels().iter().map(described).collect::<Vec<_>>(),
    });
    writeln!(out, "{head}")?;
    let (mut messages, mut bytes) = (0_u64, 0_u64);
    for message in bag.select(&selection)? {
        let message = message?;
        messages += 1;
        bytes += message.bytes.len() as u64;
        if !is_counting {
            let line = json!({
                "topic": bag.channels()[message.channel].topic, "channel": message.channel,
                "log_time_ns": message.log_time_ns, "publish_time_ns": message.publish_time_ns,
                "size": message.bytes.len(), "sha256": hex(&message.bytes),
            });
            writeln!(out, "{line}")?;
        }
    }
    if is_counting {
        writeln!(out, "{}", json!({"messages": messages, "bytes": bytes}))?;
    }
    Ok(out.flush()?)
}

fn described(channel: &Channel) -> serde_json::Value {
    let definition = channel.definition.as_ref();
    json!({
        "topic": channel.topic, "type": channel.message_type, "encoding": channel.encoding.to_string(),
        "hash": channel.type_hash, "qos": channel.qos, "latching": channel.is_latching,
        "caller_id": channel.caller_id, "definition": definition.map(|definition| &definition.text),
        "is_idl": definition.map(|definition| definition.language == Language::Idl),
        "is_read_only": matches!(channel.encoding, Encoding::Other(_)),
    })
}

fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
