//! Requests to Webots: `u32 size, u32 step in ms`, then for each device `u16 tag, i32 size, messages`.

/// A request; its buffer is used again.
#[derive(Debug, Clone, Default)]
pub(crate) struct Request {
    bytes: Vec<u8>,
}

/// Bytes before the messages of a device: tag and size.
const DEVICE_HEAD: usize = 6;

impl Request {
    /// Starts a request for a step; a step of 0 ms is carried out immediately and lets no time pass.
    pub fn begin(&mut self, step_ms: u32) {
        self.bytes.clear();
        self.u32(0);
        self.u32(step_ms);
    }

    /// Adds the messages of a device, if `write` writes any.
    pub fn device(&mut self, tag: u16, write: impl FnOnce(&mut Self)) {
        let start = self.bytes.len();
        self.u16(tag);
        self.i32(0);
        write(self);
        let size = self.bytes.len() - start - DEVICE_HEAD;
        if size == 0 {
            self.bytes.truncate(start);
        } else {
            self.bytes[start + 2..start + DEVICE_HEAD].copy_from_slice(&(size as u32).to_le_bytes());
        }
    }

    /// Writes the size and returns the bytes.
    pub fn finish(&mut self) -> &[u8] {
        let size = self.bytes.len() as u32;
        self.bytes[..4].copy_from_slice(&size.to_le_bytes());
        &self.bytes
    }

    /// Returns the bytes that were written.
    pub fn raw(&self) -> &[u8] {
        &self.bytes
    }

    /// Removes everything.
    pub fn clear(&mut self) {
        self.bytes.clear();
    }

    pub fn u8(&mut self, value: u8) {
        self.bytes.push(value);
    }

    pub fn u16(&mut self, value: u16) {
        self.bytes.extend_from_slice(&value.to_le_bytes());
    }

    pub fn u32(&mut self, value: u32) {
        self.bytes.extend_from_slice(&value.to_le_bytes());
    }

    pub fn i32(&mut self, value: i32) {
        self.bytes.extend_from_slice(&value.to_le_bytes());
    }

    pub fn f64(&mut self, value: f64) {
        self.bytes.extend_from_slice(&value.to_le_bytes());
    }

    pub fn data(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    /// Writes a string with its final zero byte.
    pub fn text(&mut self, text: &str) {
        self.data(text.as_bytes());
        self.u8(0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_without_messages_are_left_out() {
        let mut request = Request::default();
        request.begin(32);
        request.device(1, |_| ());
        request.device(2, |messages| {
            messages.u8(1);
            messages.u16(32);
        });
        let expected = [17, 0, 0, 0, 32, 0, 0, 0, 2, 0, 3, 0, 0, 0, 1, 32, 0];
        assert_eq!(request.finish(), expected);
        request.begin(0);
        assert_eq!(request.finish(), [8, 0, 0, 0, 0, 0, 0, 0]);
    }
}
