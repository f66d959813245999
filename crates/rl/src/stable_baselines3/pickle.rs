//! What PyTorch writes of a state dictionary: a pickle of names and tensors, of which nothing is run.

use std::collections::HashMap;

use opendr_engine::{Error, Result};

/// Values that are made; no policy has nearly as many.
const MAX_VALUES: usize = 1 << 18;
/// Axes of a tensor.
const MAX_AXES: usize = 8;

/// Number of a value.
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

/// Where the numbers of a tensor of single precision lie.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TensorPlace {
    /// The member of the archive.
    pub storage: String,
    /// The first number in it.
    pub offset: usize,
    /// Size of each axis; rows follow each other.
    pub shape: Vec<usize>,
}

/// A stack machine without the instructions that could run code.
struct Machine<'a> {
    bytes: &'a [u8],
    at: usize,
    values: Vec<Value>,
    stack: Vec<Id>,
    marks: Vec<usize>,
    memo: HashMap<u32, Id>,
}

/// Names and places of the tensors of a state dictionary, of protocol 2.
///
/// # Errors
/// `Format` with the byte for what is none or is cut off, `Unsupported` for what would be code.
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
        return Err(Error::format("the pickle holds no dictionary of tensors"));
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
                return Err(self.wrong("more values than a policy has"));
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
                let kept = *self.memo.get(&key).ok_or_else(|| self.wrong("a value was never kept"))?;
                self.stack.push(kept);
            }
            b's' | b'u' => self.set_items(code)?,
            b'c' => {
                let name = format!("{}.{}", self.line()?, self.line()?);
                self.push(Value::Global(name));
            }
            b'Q' => self.find_storage()?,
            b'R' => self.reduce()?,
            // Beside its entries a state dictionary has versions of modules, which nobody needs.
            b'b' => drop(self.pop()?),
            _ => {
                return Err(self.wrong(&format!("instruction {code:#04x} is unknown to a state dictionary")));
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
            _ => return Err(self.wrong("entries of what is no dictionary")),
        }
        Ok(())
    }

    /// A persistent name: `("storage", torch.FloatStorage, key, device, length)`.
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
                "numbers of kind {kind:.40}; save the policy in single precision"
            ))),
            _ => Err(self.wrong("a storage has no name")),
        }
    }

    /// The two functions that make plain data.
    fn reduce(&mut self) -> Result<()> {
        let (arguments, function) = (self.pop()?, self.pop()?);
        let (Value::Tuple(arguments), Value::Global(name)) = (self.value(arguments), self.value(function))
        else {
            return Err(self.wrong("something else than a name is called"));
        };
        let argument = |at: usize| arguments.get(at).map_or(&Value::None, |id| self.value(*id));
        let made = match name.as_str() {
            "collections.OrderedDict" => Value::Dictionary(Vec::new()),
            "torch._utils._rebuild_tensor_v2" => {
                let (Value::Storage(storage), Value::Number(offset)) = (argument(0), argument(1)) else {
                    return Err(self.wrong("a tensor without numbers"));
                };
                let (shape, strides) = (self.sizes(argument(2))?, self.sizes(argument(3))?);
                if strides.len() != shape.len() || !follows_rows(&shape, &strides) {
                    return Err(Error::unsupported("a tensor whose rows do not follow each other"));
                }
                let offset = usize::try_from(*offset).map_err(|_| self.wrong("a negative offset"))?;
                Value::Tensor(TensorPlace { storage: storage.clone(), offset, shape })
            }
            other => {
                return Err(Error::unsupported(format!(
                    "the state dictionary names {other:.80}, which is code; nothing of it was run"
                )));
            }
        };
        self.push(made);
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

    /// The values since the last mark.
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

    /// A number of that many bytes.
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

/// Whether rows follow each other; the distance along an axis of one is no matter.
fn follows_rows(shape: &[usize], strides: &[usize]) -> bool {
    let mut wanted = Some(1usize);
    shape.iter().zip(strides).rev().all(|(size, stride)| {
        let fits = *size <= 1 || wanted == Some(*stride);
        wanted = wanted.and_then(|wanted| wanted.checked_mul(*size));
        fits
    })
}

#[cfg(test)]
mod tests {
    use opendr_engine::ErrorKind;

    use super::*;

    #[test]
    fn code_is_refused_and_damage_told() {
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
    fn rows_that_follow_each_other() {
        assert!(follows_rows(&[2, 3], &[3, 1]) && follows_rows(&[1, 3], &[99, 1]) && follows_rows(&[], &[]));
        assert!(!follows_rows(&[2, 3], &[1, 2]) && !follows_rows(&[usize::MAX, 2, 2], &[0, 2, 1]));
    }
}
