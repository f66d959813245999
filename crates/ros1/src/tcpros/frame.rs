//! Messages with a length prefix.

use std::io::{self, ErrorKind, IoSlice, Read, Write};

/// Initial capacity of the buffer, in bytes.
const FIRST_ROOM: usize = 64 << 10;

/// Reads the length of the next message; returns `None` at the end of the connection.
pub(crate) fn read_length(stream: &mut impl Read) -> io::Result<Option<u32>> {
    let mut length = [0; 4];
    let mut filled = 0;
    while let Some(rest) = length.get_mut(filled..).filter(|rest| !rest.is_empty()) {
        match stream.read(rest) {
            Ok(0) if filled == 0 => return Ok(None),
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(read) => filled += read,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(Some(u32::from_le_bytes(length)))
}

/// Fills `buffer` with the next `length` bytes. The buffer grows to twice the received bytes, never to the announced length; its
/// capacity from earlier messages is reused.
pub(crate) fn read_body(stream: &mut impl Read, length: usize, buffer: &mut Vec<u8>) -> io::Result<()> {
    buffer.truncate(length);
    let mut filled = 0;
    while filled < length {
        if filled == buffer.len() {
            buffer.resize(length.min((filled * 2).max(FIRST_ROOM)), 0);
        }
        match stream.read(buffer.get_mut(filled..).unwrap_or_default()) {
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(read) => filled += read,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

/// Writes `start`, the length of `body`, and `body`, in one system call if possible.
pub(crate) fn write_frame(stream: &mut impl Write, start: &[u8], body: &[u8]) -> io::Result<()> {
    let length =
        u32::try_from(body.len()).map_err(|_| io::Error::from(ErrorKind::InvalidInput))?.to_le_bytes();
    let mut slices = [IoSlice::new(start), IoSlice::new(&length), IoSlice::new(body)];
    let mut rest = slices.as_mut_slice();
    IoSlice::advance_slices(&mut rest, 0);
    while !rest.is_empty() {
        match stream.write_vectored(rest) {
            Ok(0) => return Err(ErrorKind::WriteZero.into()),
            Ok(written) => IoSlice::advance_slices(&mut rest, written),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads and writes a few bytes at a time.
    struct Slow(Vec<u8>, usize);

    impl Read for Slow {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let taken = buffer.len().min(7).min(self.0.len() - self.1);
            buffer[..taken].copy_from_slice(&self.0[self.1..self.1 + taken]);
            self.1 += taken;
            Ok(taken)
        }
    }

    impl Write for Slow {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let taken = bytes.len().min(5);
            self.0.extend(&bytes[..taken]);
            Ok(taken)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn frames_come_back_into_one_buffer() {
        let mut stream = Slow(Vec::new(), 0);
        let messages = [vec![1; 1000], vec![], vec![2; 10], (0..200_000).map(|at| at as u8).collect()];
        for message in &messages {
            write_frame(&mut stream, b"", message).unwrap();
        }
        let mut buffer = Vec::new();
        for message in &messages {
            let length = read_length(&mut stream).unwrap().unwrap();
            read_body(&mut stream, length as usize, &mut buffer).unwrap();
            assert_eq!(&buffer, message);
        }
        assert_eq!(read_length(&mut stream).unwrap(), None);
    }

    #[test]
    fn an_announced_length_allocates_no_memory() {
        let mut buffer = Vec::new();
        let error = read_body(&mut Slow(vec![1; 100], 0), u32::MAX as usize, &mut buffer).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::UnexpectedEof);
        assert!(buffer.capacity() <= 2 * FIRST_ROOM);
        assert!(read_length(&mut &b"\x01\0"[..]).is_err());
    }
}
