//! The pickle of a PyTorch state dictionary: names and tensors. No code in it is run.

use std::collections::HashMap;

use opendr_engine::{Error, Result};

/// Maximum number of values.
const MAX_VALUES: usize = 1 << 18;
/// Maximum number of axes of a tensor.
const MAX_AXES: usize = 8;

/// Index of a value.
type Id = usize;

#[derive(Debug, Clone)]
enum Value {
    None,
    Number(i64),
    Text(String),
    Tuple(Vec<Id>),
    Dictionary(Vec<(Id, Id)>),
    /// Module and name, as in `torch.FloatStorage`.
    Global(String),
    Storage(String),
    Tensor(TensorPlace),
}

/// Location of the numbers of a single-precision tensor.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TensorPlace {
    /// The member of the archive.
    pub storage: String,
    /// Index of its first number in the storage.
    pub offset: usize,
    /// Size of each axis, in row-major order.
    pub shape: Vec<usize>,
}

/// A stack machine of pickle instructions, without those that run code.
struct Machine<'a> {
    bytes: &'a [u8],
    at: usize,
    values: Vec<Value>,
    stack: Vec<Id>,
    marks: Vec<usize>,
    memo: HashMap<u32, Id>,
}

/// Returns the names and locations of the tensors of a state dictionary, in protocol 2.
///
/// # Errors
/// `Format`, with the byte offset, for damaged data, `Unsupported` for data that would run code.
pub(super) fn tensors_from_pickle(bytes: &[u8]) -> Result<Vec<(String, TensorPlace)>> {
    let mut machine = Machine {
        bytes,
        at: 0,
        values: Vec::new(),
        stack: Vec::new(),
        marks: Vec::new(),
        memo: HashMap::new(),
    };
    let root = machine.run()?;
    let Value::Dictionary(entries) = machine.value(root) else {
        return Err(Error::format("the pickle is not a dictionary of tensors"));
    };
    let named =
        entries.iter().filter_map(|(name, tensor)| match (machine.value(*name), machine.value(*tensor)) {
            (Value::Text(name), Value::Tensor(place)) => Some((name.clone(), place.clone())),
            _ => None,
        });
    Ok(named.collect())
}

impl<'a> Machine<'a> {
    fn run(&mut self) -> Result<Id> {
        loop {
            if self.values.len() > MAX_VALUES {
                return Err(self.wrong(&format!("more than {MAX_VALUES} values")));
            }
            match self.take(1)?[0] {
                b'.' => return self.pop(),
                code => self.step(code)?,
            }
        }
    }

    fn step(&mut self, code: u8) -> Result<()> {
        match code {
            0x80 => drop(self.take(1)?),
            b'(' => self.marks.push(self.stack.len()),
            b')' => self.push(Value::Tuple(Vec::new())),
            b'}' => self.push(Value::Dictionary(Vec::new())),
            b'N' | 0x88 | 0x89 => self.push(Value::None),
            b'K' => {
                let number = self.take(1)?[0];
                self.push(Value::Number(number.into()));
            }
            b'M' => {
                let number = self.word(2)?;
                self.push(Value::Number(number.into()));
            }
            b'J' => {
                let number = self.word(4)? as i32;
                self.push(Value::Number(number.into()));
            }
            b'X' => {
                let length = self.word(4)? as usize;
                let text = String::from_utf8_lossy(self.take(length)?).into_owned();
                self.push(Value::Text(text));
            }
            b't' => {
                let values = self.marked()?;
                self.push(Value::Tuple(values));
            }
            0x85..=0x87 => {
                let count = usize::from(code - 0x84);
                let start = self.stack.len().checked_sub(count);
                let values = self.stack.split_off(start.ok_or_else(|| self.wrong("a value is missing"))?);
                self.push(Value::Tuple(values));
            }
            b'q' | b'r' => {
                let key = self.word(if code == b'q' { 1 } else { 4 })?;
                let top = *self.stack.last().ok_or_else(|| self.wrong("a value is missing"))?;
                self.memo.insert(key, top);
            }
            b'h' | b'j' => {
                let key = self.word(if code == b'h' { 1 } else { 4 })?;
                let kept = *self.memo.get(&key).ok_or_else(|| self.wrong("a memo entry is missing"))?;
                self.stack.push(kept);
            }
            b's' | b'u' => self.set_items(code)?,
            b'c' => {
                let name = format!("{}.{}", self.line()?, self.line()?);
                self.push(Value::Global(name));
            }
            b'Q' => self.find_storage()?,
            b'R' => self.reduce()?,
            // The state beside the entries holds module versions, which are not needed.
            b'b' => drop(self.pop()?),
            _ => {
                return Err(
                    self.wrong(&format!("instruction {code:#04x} does not belong in a state dictionary"))
                );
            }
        }
        Ok(())
    }

    fn set_items(&mut self, code: u8) -> Result<()> {
        let pairs = match code {
            b's' => {
                let value = self.pop()?;
                vec![self.pop()?, value]
            }
            _ => self.marked()?,
        };
        let pairs = pairs.as_chunks::<2>().0.iter().map(|[name, value]| (*name, *value));
        match self.stack.last().and_then(|id| self.values.get_mut(*id)) {
            Some(Value::Dictionary(entries)) => entries.extend(pairs),
            _ => return Err(self.wrong("entries without a dictionary")),
        }
        Ok(())
    }

    /// Resolves a persistent id: `("storage", torch.FloatStorage, key, device, length)`.
    fn find_storage(&mut self) -> Result<()> {
        let name = self.pop()?;
        let Value::Tuple(parts) = self.value(name) else { return Err(self.wrong("a storage has no name")) };
        let part = |at: usize| parts.get(at).map_or(&Value::None, |id| self.value(*id));
        match (part(1), part(2)) {
            (Value::Global(kind), Value::Text(key)) if kind == "torch.FloatStorage" => {
                let key = key.clone();
                self.push(Value::Storage(key));
                Ok(())
            }
            (Value::Global(kind), _) => Err(Error::unsupported(format!(
                "storage type {kind:.40} is not supported; save the policy in single precision"
            ))),
            _ => Err(self.wrong("a storage has no name")),
        }
    }

    /// Calls one of the two supported functions, which only build data.
    fn reduce(&mut self) -> Result<()> {
        let (arguments, function) = (self.pop()?, self.pop()?);
        let (Value::Tuple(arguments), Value::Global(name)) = (self.value(arguments), self.value(function))
        else {
            return Err(self.wrong("the called value is not a function name"));
        };
        let argument = |at: usize| arguments.get(at).map_or(&Value::None, |id| self.value(*id));
        let value = match name.as_str() {
            "collections.OrderedDict" => Value::Dictionary(Vec::new()),
            "torch._utils._rebuild_tensor_v2" => {
                let (Value::Storage(storage), Value::Number(offset)) = (argument(0), argument(1)) else {
                    return Err(self.wrong("a tensor has no storage"));
                };
                let (shape, strides) = (self.sizes(argument(2))?, self.sizes(argument(3))?);
                if strides.len() != shape.len() || !is_contiguous(&shape, &strides) {
                    return Err(Error::unsupported(
                        "a tensor is not contiguous; save the policy with contiguous tensors",
                    ));
                }
                let offset = usize::try_from(*offset).map_err(|_| self.wrong("a negative offset"))?;
                Value::Tensor(TensorPlace { storage: storage.clone(), offset, shape })
            }
            other => {
                return Err(Error::unsupported(format!(
                    "the state dictionary calls {other:.80}, which is not allowed; nothing was run"
                )));
            }
        };
        self.push(value);
        Ok(())
    }

    fn sizes(&self, value: &Value) -> Result<Vec<usize>> {
        let Value::Tuple(sizes) = value else { return Err(self.wrong("a tensor has no shape")) };
        let size = |id: &Id| match self.value(*id) {
            Value::Number(size) => usize::try_from(*size).ok(),
            _ => None,
        };
        let sizes: Option<Vec<_>> = sizes.iter().take(MAX_AXES + 1).map(size).collect();
        sizes.filter(|sizes| sizes.len() <= MAX_AXES).ok_or_else(|| self.wrong("a tensor has no shape"))
    }

    fn value(&self, id: Id) -> &Value {
        self.values.get(id).unwrap_or(&Value::None)
    }

    fn push(&mut self, value: Value) {
        self.stack.push(self.values.len());
        self.values.push(value);
    }

    fn pop(&mut self) -> Result<Id> {
        self.stack.pop().ok_or_else(|| self.wrong("a value is missing"))
    }

    /// Pops the values since the last mark.
    fn marked(&mut self) -> Result<Vec<Id>> {
        let mark = self.marks.pop().filter(|mark| *mark <= self.stack.len());
        Ok(self.stack.split_off(mark.ok_or_else(|| self.wrong("a mark is missing"))?))
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8]> {
        let taken = self.at.checked_add(count).and_then(|end| self.bytes.get(self.at..end));
        let taken = taken.ok_or_else(|| self.wrong("the pickle is cut off"))?;
        self.at += count;
        Ok(taken)
    }

    /// Reads a little-endian number of `bytes` bytes.
    fn word(&mut self, bytes: usize) -> Result<u32> {
        Ok(self.take(bytes)?.iter().rev().fold(0, |word, byte| (word << 8) | u32::from(*byte)))
    }

    fn line(&mut self) -> Result<String> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let end = rest.iter().position(|byte| *byte == b'\n').filter(|end| *end < 200);
        let line = self.take(end.ok_or_else(|| self.wrong("a name has no end"))?)?;
        self.at += 1;
        Ok(String::from_utf8_lossy(line).into_owned())
    }

    fn wrong(&self, what: &str) -> Error {
        Error::format(format!("byte {} of the state dictionary: {what}; the file is damaged", self.at))
    }
}

/// Returns whether a tensor is contiguous; the stride of an axis of size 1 does not matter.
fn is_contiguous(shape: &[usize], strides: &[usize]) -> bool {
    let mut expected = Some(1usize);
    shape.iter().zip(strides).rev().all(|(size, stride)| {
        let fits = *size <= 1 || expected == Some(*stride);
        expected = expected.and_then(|expected| expected.checked_mul(*size));
        fits
    })
}

#[cfg(test)]
mod tests {
    use opendr_engine::ErrorKind;

    use super::*;

    #[test]
    fn code_and_damage_are_refused() {
        let code = b"\x80\x02cos\nsystem\nX\x02\x00\x00\x00ls\x85R.";
        assert_eq!(tensors_from_pickle(code).unwrap_err().kind(), ErrorKind::Unsupported);
        for damaged in
            [&b""[..], b".", b"\x80\x02", b"X\xff\xff\xff\xff", b"t.", b"\x87.", b"h\x01.", b"}u.", b"i"]
        {
            assert_eq!(tensors_from_pickle(damaged).unwrap_err().kind(), ErrorKind::Format, "{damaged:?}");
        }
        assert!(tensors_from_pickle(b"\x80\x02}.").unwrap().is_empty());
    }

    #[test]
    fn contiguous_tensors_are_recognised() {
        assert!(
            is_contiguous(&[2, 3], &[3, 1]) && is_contiguous(&[1, 3], &[99, 1]) && is_contiguous(&[], &[])
        );
        assert!(!is_contiguous(&[2, 3], &[1, 2]) && !is_contiguous(&[usize::MAX, 2, 2], &[0, 2, 1]));
    }
}
