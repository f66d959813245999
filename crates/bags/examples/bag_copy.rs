//! Copies a recording into another format, and prints which channels the format does not support.
//!
//! `cargo run -p opendr-bags --example bag_copy -- IN OUT --format bag1|bag2_sqlite|bag2_mcap|mcap [--lz4] [--overwrite]`

use opendr_bags::{Bag, BagFormat, BagWriter, Compression, WriteOptions};
use opendr_engine::{Error, Result};

fn main() -> Result<()> {
    let mut options = WriteOptions::new(BagFormat::Mcap);
    let mut paths = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--format" => options.format = arguments.next().unwrap_or_default().parse()?,
            "--lz4" => options.compression = Compression::Lz4,
            "--overwrite" => options.overwrite = true,
            _ => paths.push(argument),
        }
    }
    let [from, to] = &paths[..] else { return Err(Error::invalid_param("name two recordings: IN OUT")) };
    let bag = Bag::open(from)?;
    let mut writer = BagWriter::create(to, options)?;
    let mut numbers = Vec::new();
    for channel in bag.channels() {
        let number = writer.add_channel(channel.clone());
        if let Err(error) = &number {
            eprintln!("skipped: {error}");
        }
        numbers.push(number.ok());
    }
    for message in bag.messages()? {
        let message = message?;
        if let Some(number) = numbers[message.channel] {
            writer.copy(number, &message)?;
        }
    }
    writer.finish()
}
