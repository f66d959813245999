//! The channels that an emitter or receiver may use.

use opendr_engine::Result;

use crate::reader::Reader;

/// Skips the list of allowed channels: Webots itself enforces it.
pub(super) fn skip(reader: &mut Reader<'_>) -> Result<()> {
    const CHANNEL: usize = 4;
    // A size of -1 stands for no list.
    if reader.clone().i32()? < 0 {
        return reader.i32().map(drop);
    }
    let count = reader.count(CHANNEL)?;
    reader.bytes(count * CHANNEL).map(drop)
}
