//! Search for the end of a JSON value without parsing it.

/// State of the scan of one value; the text may be passed in blocks.
#[derive(Default)]
pub(super) struct Extent {
    depth: usize,
    in_string: bool,
    escaped: bool,
}

impl Extent {
    /// Returns the end of the value in `block`, which follows the previous blocks; `None` if the value continues after it.
    pub(super) fn of(&mut self, block: &[u8]) -> Option<usize> {
        let mut at = 0;
        while let Some(byte) = block.get(at).copied() {
            if self.in_string {
                at += self.string(&block[at..]);
                if !self.in_string && self.depth == 0 {
                    return Some(at);
                }
                continue;
            }
            match byte {
                b'"' => self.in_string = true,
                b'{' | b'[' => self.depth += 1,
                b'}' | b']' if self.depth <= 1 => return Some(at + self.depth),
                b'}' | b']' => self.depth -= 1,
                b',' | b':' | b' ' | b'\t' | b'\r' | b'\n' if self.depth == 0 => return Some(at),
                _ => {}
            }
            at += 1;
        }
        None
    }

    /// Returns whether the value may end with the text: only numbers and words have no delimiter of their own.
    pub(super) fn may_end(&self) -> bool {
        self.depth == 0 && !self.in_string
    }

    /// Returns the number of bytes up to and including the closing quotation mark, or of all.
    fn string(&mut self, text: &[u8]) -> usize {
        let mut at = 0;
        if self.escaped {
            self.escaped = false;
            at = 1;
        }
        while let Some(byte) = text.get(at) {
            match byte {
                b'"' => {
                    self.in_string = false;
                    return at + 1;
                }
                b'\\' if at + 1 == text.len() => {
                    self.escaped = true;
                    return at + 1;
                }
                b'\\' => at += 2,
                _ => at += 1,
            }
        }
        at
    }
}
