//! Rows in SQLite's record format.

/// A value of a row.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    Null,
    Int(i64),
    Real(f64),
    Text(String),
    Bytes,
}

/// Reads a variable-length integer of up to nine bytes. Returns it and the rest.
pub fn varint(bytes: &[u8]) -> Option<(i64, &[u8])> {
    let mut number = 0u64;
    for at in 0..8 {
        let byte = *bytes.get(at)?;
        number = number << 7 | u64::from(byte & 0x7f);
        if byte < 0x80 {
            return Some((number as i64, bytes.get(at + 1..)?));
        }
    }
    Some(((number << 8 | u64::from(*bytes.get(8)?)) as i64, bytes.get(9..)?))
}

/// Returns the values of a row. If the first is `Null`, it is the key: SQLite does not store an integer
/// primary key in the row, and it is the first column in all of Optuna's tables.
pub fn cells_from_record(record: &[u8], key: i64) -> Option<Vec<Cell>> {
    let (length, _) = varint(record)?;
    let length = usize::try_from(length).ok()?;
    let mut kinds = varint(record.get(..length)?)?.1;
    let mut body = record.get(length..)?;
    let mut cells = Vec::new();
    while !kinds.is_empty() {
        let (kind, rest) = varint(kinds)?;
        kinds = rest;
        let size = match kind {
            0 | 8 | 9 => 0,
            1..=4 => kind as usize,
            5 => 6,
            6 | 7 => 8,
            12.. => usize::try_from((kind - 12) / 2).ok()?,
            _ => return None,
        };
        let (value, rest) = body.split_at_checked(size)?;
        body = rest;
        cells.push(match kind {
            0 => Cell::Null,
            7 => Cell::Real(f64::from_be_bytes(value.try_into().ok()?)),
            8 | 9 => Cell::Int(kind - 8),
            1..=6 => Cell::Int(signed(value)),
            _ if kind % 2 == 0 => Cell::Bytes,
            _ => Cell::Text(String::from_utf8(value.to_vec()).ok()?),
        });
    }
    if let Some(first @ Cell::Null) = cells.first_mut() {
        *first = Cell::Int(key);
    }
    Some(cells)
}

fn signed(bytes: &[u8]) -> i64 {
    let sign = if bytes.first().is_some_and(|byte| *byte >= 0x80) { -1 } else { 0 };
    bytes.iter().fold(sign, |number, byte| number << 8 | i64::from(*byte))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn varints() {
        assert_eq!(varint(&[0x7f, 9]), Some((127, &[9][..])));
        assert_eq!(varint(&[0x81, 0x00]), Some((128, &[][..])));
        assert_eq!(varint(&[0xff; 9]), Some((-1, &[][..])));
        assert_eq!(varint(&[0x81]), None);
    }

    #[test]
    fn records() {
        // Length of the header, null, one byte, eight bytes of a double, 1, text of 2, bytes of 1.
        let mut record = vec![7, 0, 1, 7, 9, 17, 14, 0xfe];
        record.extend(1.5f64.to_be_bytes());
        record.extend(b"hix");
        let expected = [
            Cell::Int(42),
            Cell::Int(-2),
            Cell::Real(1.5),
            Cell::Int(1),
            Cell::Text("hi".to_owned()),
            Cell::Bytes,
        ];
        assert_eq!(cells_from_record(&record, 42).unwrap(), expected);
        for cut in 0..record.len() {
            assert_eq!(cells_from_record(&record[..cut], 42), None);
        }
    }
}
