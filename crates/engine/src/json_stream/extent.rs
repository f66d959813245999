//! Where a JSON value ends, found without parsing it.

/// How far the scan of one value has come; the text may be fed in blocks.
#[derive(Default)]
pub(super) struct Extent {
    depth: usize,
    in_string: bool,
    escaped: bool,
}

impl Extent {
    /// The end of the value in `block`, the text after what was fed before; `None` when it goes on behind.
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

    /// Whether the text may end here: only a number or word needs nothing to end it.
    pub(super) fn may_end(&self) -> bool {
        self.depth == 0 && !self.in_string
    }

    /// Bytes up to and with the closing quotation mark, or all of them.
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
