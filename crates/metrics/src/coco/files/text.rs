//! Parsing of the JSON of one record.

use std::borrow::Cow;

/// An error, and the byte of the record at which it occurred.
#[derive(Debug, PartialEq)]
pub(super) struct Fault {
    pub at: usize,
    pub what: String,
}

pub(super) type Parsed<T> = Result<T, Fault>;

/// A cursor in the bytes of a record.
pub(super) struct Text<'a> {
    bytes: &'a [u8],
    at: usize,
}

/// Powers of ten that an `f64` represents exactly.
const TENS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

impl<'a> Text<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    /// Returns an error at the next byte.
    pub(super) fn fault<T>(&self, what: impl Into<String>) -> Parsed<T> {
        Err(Fault { at: self.at, what: what.into() })
    }

    /// Parses an object; `each` parses the value of each key.
    pub(super) fn object(&mut self, mut each: impl FnMut(&mut Self, &'a [u8]) -> Parsed<()>) -> Parsed<()> {
        self.list(b'{', b'}', "an object", |text| {
            let key = text.quoted("a key")?;
            match text.peek() {
                Some(b':') => text.at += 1,
                _ => return text.fault("expected \":\" after a key"),
            }
            each(text, key)
        })
    }

    /// Parses an array; `each` parses each element.
    pub(super) fn array(&mut self, each: impl FnMut(&mut Self) -> Parsed<()>) -> Parsed<()> {
        self.list(b'[', b']', "an array", each)
    }

    /// Parses exactly `N` numbers; `None` for an empty array.
    pub(super) fn numbers<const N: usize>(&mut self) -> Parsed<Option<[f64; N]>> {
        let (mut numbers, mut count) = ([0.0; N], 0);
        self.array(|text| {
            let number = text.number()?;
            match numbers.get_mut(count) {
                Some(place) => *place = number,
                None => return text.fault(format!("more than {N} numbers")),
            }
            count += 1;
            Ok(())
        })?;
        match count {
            0 => Ok(None),
            _ if count == N => Ok(Some(numbers)),
            _ => self.fault(format!("{count} numbers instead of {N}")),
        }
    }

    /// Returns whether the next value is null, and skips it.
    pub(super) fn null(&mut self) -> bool {
        self.peek();
        let found = self.bytes[self.at..].starts_with(b"null");
        self.at += if found { 4 } else { 0 };
        found
    }

    /// Returns whether the next value is an object.
    pub(super) fn is_object(&mut self) -> bool {
        self.peek() == Some(b'{')
    }

    /// Returns whether the next value is a string.
    pub(super) fn is_string(&mut self) -> bool {
        self.peek() == Some(b'"')
    }

    /// Parses a finite number, exact to the last bit.
    pub(super) fn number(&mut self) -> Parsed<f64> {
        self.peek();
        let start = self.at;
        let rest = &self.bytes[start..];
        let negative = rest.first() == Some(&b'-');
        let (mut at, mut digits, mut mantissa) = (usize::from(negative), 0u32, 0u64);
        let mut more = |at: &mut usize| {
            let first = *at;
            while let Some(digit) =
                rest.get(*at).map(|byte| byte.wrapping_sub(b'0')).filter(|digit| *digit < 10)
            {
                mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
                digits += 1;
                *at += 1;
            }
            *at - first
        };
        let whole = more(&mut at);
        let mut decimals = 0;
        let mut valid = whole > 0;
        if rest.get(at) == Some(&b'.') {
            at += 1;
            decimals = more(&mut at);
            valid &= decimals > 0;
        }
        if !valid {
            let word: String = rest.iter().take(12).map(|byte| char::from(*byte)).collect();
            let word = word.split([',', ']', '}', ' ']).next().unwrap_or_default();
            return self.fault(format!("expected a number, found {word:?}"));
        }
        let exponent = matches!(rest.get(at), Some(b'e' | b'E'));
        if !exponent && digits <= 19 && mantissa <= 1 << 53 && decimals < TENS.len() {
            self.at = start + at;
            let number = mantissa as f64 / TENS[decimals];
            return Ok(if negative { -number } else { number });
        }
        if exponent {
            at += 1 + usize::from(matches!(rest.get(at + 1), Some(b'+' | b'-')));
            at += rest[at.min(rest.len())..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        }
        let text = std::str::from_utf8(&rest[..at.min(rest.len())]).unwrap_or_default();
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => {
                self.at = start + at;
                Ok(number)
            }
            _ => self.fault(format!("{text:.40} is not a finite number")),
        }
    }

    /// Parses an integer.
    pub(super) fn whole(&mut self) -> Parsed<i64> {
        self.peek();
        let start = self.at;
        let digits = self.bytes[start..].iter().skip(usize::from(self.bytes.get(start) == Some(&b'-')));
        let count = digits.clone().take_while(|byte| byte.is_ascii_digit()).count();
        let number = self.number()?;
        if (1..=15).contains(&count) && self.at - start <= count + 1 {
            return Ok(number as i64);
        }
        let text = std::str::from_utf8(&self.bytes[start..self.at]).unwrap_or_default();
        match text.parse() {
            Ok(whole) => Ok(whole),
            Err(_) if number.fract() == 0.0 && number.abs() < 9e15 => Ok(number as i64),
            Err(_) => Err(Fault { at: start, what: format!("expected an integer, found {text:.40}") }),
        }
    }

    /// Parses true, false, or a number, which is true unless it is 0.
    pub(super) fn flag(&mut self) -> Parsed<bool> {
        self.peek();
        for (word, value) in [("true", true), ("false", false)] {
            if self.bytes[self.at..].starts_with(word.as_bytes()) {
                self.at += word.len();
                return Ok(value);
            }
        }
        Ok(self.number()? != 0.0)
    }

    /// Parses a string.
    pub(super) fn string(&mut self) -> Parsed<Cow<'a, str>> {
        self.peek();
        let start = self.at;
        let inner = self.quoted("text")?;
        let invalid =
            |_| Fault { at: start, what: "text that is not UTF-8 or has an invalid escape".to_owned() };
        if inner.contains(&b'\\') {
            return serde_json::from_slice(&self.bytes[start..self.at])
                .map(Cow::Owned)
                .map_err(|_| invalid(()));
        }
        std::str::from_utf8(inner).map(Cow::Borrowed).map_err(|_| invalid(()))
    }

    /// Skips a value; only its brackets are checked.
    pub(super) fn skip(&mut self) -> Parsed<()> {
        let mut depth = 0usize;
        loop {
            match self.peek() {
                Some(b'"') => {
                    self.quoted("text")?;
                }
                Some(b'[' | b'{') => {
                    depth += 1;
                    self.at += 1;
                }
                Some(b']' | b'}') if depth > 0 => {
                    depth -= 1;
                    self.at += 1;
                }
                Some(b',' | b':') if depth > 0 => self.at += 1,
                None | Some(b',' | b':' | b']' | b'}') => return self.fault("expected a value"),
                Some(_) => {
                    let inside = |byte: &u8| !matches!(byte, b',' | b']' | b'}' | b':' | b'"' | b'[' | b'{');
                    let length = self.bytes[self.at..].iter().take_while(|byte| inside(byte)).count();
                    self.at += length;
                }
            }
            if depth == 0 {
                return Ok(());
            }
        }
    }

    /// Checks that the text ends here.
    pub(super) fn end(&mut self) -> Parsed<()> {
        match self.peek() {
            None => Ok(()),
            Some(_) => self.fault("expected the end of the record"),
        }
    }

    fn list(
        &mut self,
        opening: u8,
        closing: u8,
        what: &str,
        mut each: impl FnMut(&mut Self) -> Parsed<()>,
    ) -> Parsed<()> {
        if self.peek() != Some(opening) {
            return self.fault(format!("expected {what}"));
        }
        self.at += 1;
        if self.peek() == Some(closing) {
            self.at += 1;
            return Ok(());
        }
        loop {
            each(self)?;
            match self.peek() {
                Some(b',') => self.at += 1,
                Some(byte) if byte == closing => {
                    self.at += 1;
                    return Ok(());
                }
                _ => return self.fault(format!("expected \",\" or {:?}", char::from(closing))),
            }
        }
    }

    /// Returns the raw bytes between quotation marks.
    fn quoted(&mut self, what: &str) -> Parsed<&'a [u8]> {
        if self.peek() != Some(b'"') {
            return self.fault(format!("expected {what} in quotation marks"));
        }
        let bytes = self.bytes;
        let start = self.at + 1;
        let mut end = start;
        loop {
            match bytes.get(end) {
                Some(b'"') => break,
                Some(b'\\') => end += 2,
                Some(_) => end += 1,
                None => return self.fault("text without an end"),
            }
        }
        self.at = end + 1;
        Ok(&bytes[start..end])
    }

    /// Returns the next byte that is not white space.
    fn peek(&mut self) -> Option<u8> {
        loop {
            let byte = *self.bytes.get(self.at)?;
            if !matches!(byte, b' ' | b'\n' | b'\r' | b'\t') {
                return Some(byte);
            }
            self.at += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn numbers_are_exact() {
        for text in
            ["0", "-1.5", "12.7", "0.1", "123456789.123456789", "9007199254740993", "1e3", "2.5E-3", "1e+2"]
        {
            let number = Text::new(text.as_bytes()).number().unwrap();
            assert_eq!(number.to_bits(), text.parse::<f64>().unwrap().to_bits(), "{text}");
        }
        for text in ["", "-", ".5", "1.", "NaN", "Infinity", "1e999", "1e", "\"1\"", "--1"] {
            assert!(Text::new(text.as_bytes()).number().is_err(), "{text}");
        }
        assert_eq!(Text::new(b"9223372036854775807").whole(), Ok(i64::MAX));
        assert_eq!(Text::new(b" -3.0").whole(), Ok(-3));
        assert!(Text::new(b"3.5").whole().is_err() && Text::new(b"92233720368547758070").whole().is_err());
        assert_eq!(Text::new(b"[1, 2]").numbers(), Ok(Some([1.0, 2.0])));
        assert_eq!(Text::new(b"[ ]").numbers::<4>(), Ok(None));
        assert!(Text::new(b"[1]").numbers::<2>().is_err() && Text::new(b"[1,2,3]").numbers::<2>().is_err());
    }

    #[test]
    fn texts_and_flags() {
        assert_eq!(Text::new(br#""a\\b\u00e9""#).string().unwrap(), "a\\b\u{e9}");
        assert_eq!(Text::new(b"\"ab\"").string().unwrap(), "ab");
        assert!(Text::new(b"\"a").string().is_err() && Text::new(b"\"\xff\"").string().is_err());
        assert_eq!(
            ["true", "0", "1"].map(|text| Text::new(text.as_bytes()).flag().unwrap()),
            [true, false, true]
        );
    }

    #[test]
    fn values_are_skipped() {
        let text = br#"{"a": {"b": ["]", 1, {}], "c": "\"}"}, "x": 7, "y": null}"#;
        let mut found = None;
        let mut json = Text::new(text);
        let each = |text: &mut Text<'_>, key: &[u8]| match key {
            b"x" => {
                found = Some(text.whole()?);
                Ok(())
            }
            _ => text.skip(),
        };
        json.object(each).and_then(|()| json.end()).unwrap();
        assert_eq!(found, Some(7));
        assert!(Text::new(b"[1, {}").skip().is_err() && Text::new(b"]").skip().is_err());
    }

    proptest! {
        #[test]
        fn any_bytes_are_rejected_or_read(bytes in proptest::collection::vec(any::<u8>(), 0..40)) {
            let _ = (Text::new(&bytes).number(), Text::new(&bytes).whole(), Text::new(&bytes).skip());
            let _ = (Text::new(&bytes).string(), Text::new(&bytes).numbers::<2>(), Text::new(&bytes).flag());
            let _ = Text::new(&bytes).object(|text, _| text.skip());
        }

        #[test]
        fn printed_numbers_are_read(number in any::<f64>().prop_filter("finite", |number| number.is_finite())) {
            for text in [format!("{number}"), format!("{number:e}")] {
                prop_assert_eq!(Text::new(text.as_bytes()).number().unwrap().to_bits(), number.to_bits());
            }
        }
    }
}
