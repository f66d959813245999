//! Stack machine of pickles, without the instructions that could execute code.

use std::cell::Cell;
use std::collections::HashMap;

use opendr_engine::{Error, Result};

use crate::npy::NpyType;
use crate::pickle::item::{Id, Item};

/// Largest number of axes of an array.
const MAX_AXES: usize = 32;
/// Largest number of values.
const MAX_ITEMS: usize = 16 << 20;
/// Limit of copied bytes as a multiple of the file size, since a pickle may copy a value many times.
const MAX_COPIES: usize = 4;

pub(super) struct Machine<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) at: usize,
    pub(super) items: Vec<Item>,
    pub(super) stack: Vec<Id>,
    pub(super) marks: Vec<usize>,
    pub(super) memo: HashMap<u64, Id>,
    pub(super) copied: Cell<usize>,
}

impl<'a> Machine<'a> {
    /// Runs to the end and returns the last value.
    pub(super) fn run(&mut self) -> Result<Id> {
        loop {
            let start = self.at;
            let [code] = self.fixed()?;
            if code == b'.' {
                return self.pop();
            }
            if self.items.len().max(self.memo.len()) > MAX_ITEMS {
                return Err(Error::invalid_input(format!(
                    "the pickle has over {MAX_ITEMS} values; split the data set"
                )));
            }
            if !(self.scalar(code)? || self.collection(code)? || self.memory(code)? || self.object(code)?) {
                return Err(Error::format(format!(
                    "byte {start}: instruction {code:#04x} is not supported in pickles of data"
                )));
            }
        }
    }

    fn wrong(&self, what: &str) -> Error {
        Error::format(format!("byte {}: {what}; the file is damaged", self.at))
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8]> {
        let end = self.at.checked_add(count);
        let taken = end
            .and_then(|end| self.bytes.get(self.at..end))
            .ok_or_else(|| self.wrong("the pickle is truncated"))?;
        self.at += count;
        Ok(taken)
    }

    fn fixed<const N: usize>(&mut self) -> Result<[u8; N]> {
        let taken = self.take(N)?;
        taken.try_into().map_err(|_| self.wrong("the pickle is truncated"))
    }

    /// Takes bytes preceded by their length of `N` bytes.
    fn counted<const N: usize>(&mut self) -> Result<&'a [u8]> {
        let mut length = [0; 8];
        let bytes: [u8; N] = self.fixed()?;
        length.iter_mut().zip(bytes).for_each(|(to, from)| *to = from);
        let length = usize::try_from(u64::from_le_bytes(length)).unwrap_or(usize::MAX);
        self.take(length)
    }

    /// Counts copied bytes; fails over the limit.
    fn copy<'b>(&self, bytes: &'b [u8]) -> Result<&'b [u8]> {
        let copied = self.copied.get().saturating_add(bytes.len());
        self.copied.set(copied);
        match copied <= self.bytes.len().saturating_mul(MAX_COPIES) {
            true => Ok(bytes),
            false => Err(self.wrong("the same bytes are copied too often")),
        }
    }

    fn line(&mut self) -> Result<String> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let end =
            rest.iter().position(|byte| *byte == b'\n').ok_or_else(|| self.wrong("a line has no end"))?;
        let line = self.take(end)?;
        self.at += 1;
        Ok(String::from_utf8_lossy(line).into_owned())
    }

    fn push(&mut self, item: Item) -> Id {
        let id = self.items.len();
        self.items.push(item);
        self.stack.push(id);
        id
    }

    fn pop(&mut self) -> Result<Id> {
        self.stack.pop().ok_or_else(|| self.wrong("a value is missing"))
    }

    /// Takes the values since the last mark.
    fn marked(&mut self) -> Result<Vec<Id>> {
        let mark = self.marks.pop().filter(|mark| *mark <= self.stack.len());
        let mark = mark.ok_or_else(|| self.wrong("a mark is missing"))?;
        Ok(self.stack.split_off(mark))
    }

    fn item(&self, id: Id) -> &Item {
        self.items.get(id).unwrap_or(&Item::None)
    }

    fn scalar(&mut self, code: u8) -> Result<bool> {
        let text = |bytes: &[u8]| Item::Text(String::from_utf8_lossy(bytes).into_owned());
        let item = match code {
            b'N' => Item::None,
            0x88 => Item::Whole(1),
            0x89 => Item::Whole(0),
            b'J' => Item::Whole(i32::from_le_bytes(self.fixed()?).into()),
            b'K' => Item::Whole(u8::from_le_bytes(self.fixed()?).into()),
            b'M' => Item::Whole(u16::from_le_bytes(self.fixed()?).into()),
            0x8a => {
                let bytes = self.counted::<1>()?;
                let mut word = [if bytes.last().is_some_and(|byte| *byte > 127) { 0xff } else { 0 }; 8];
                if bytes.len() > word.len() {
                    return Err(self.wrong("an integer has over 64 bits"));
                }
                word.iter_mut().zip(bytes).for_each(|(to, from)| *to = *from);
                Item::Whole(i64::from_le_bytes(word))
            }
            b'G' => Item::Float(f64::from_be_bytes(self.fixed()?)),
            b'X' => text(self.counted::<4>()?),
            0x8c => text(self.counted::<1>()?),
            0x8d => text(self.counted::<8>()?),
            b'B' | b'T' => Item::Bytes(self.counted::<4>()?.to_vec()),
            b'C' | b'U' => Item::Bytes(self.counted::<1>()?.to_vec()),
            0x8e | 0x96 => Item::Bytes(self.counted::<8>()?.to_vec()),
            _ => return Ok(false),
        };
        self.push(item);
        Ok(true)
    }

    fn collection(&mut self, code: u8) -> Result<bool> {
        match code {
            b'(' => self.marks.push(self.stack.len()),
            b']' | b')' => drop(self.push(Item::List(Vec::new()))),
            b'}' => drop(self.push(Item::Dictionary(Vec::new()))),
            b't' | b'l' => {
                let values = self.marked()?;
                self.push(Item::List(values));
            }
            0x85..=0x87 => {
                let count = usize::from(code - 0x84);
                let start =
                    self.stack.len().checked_sub(count).ok_or_else(|| self.wrong("a value is missing"))?;
                let values = self.stack.split_off(start);
                self.push(Item::List(values));
            }
            b'a' | b'e' => {
                let values = if code == b'a' { vec![self.pop()?] } else { self.marked()? };
                match self.stack.last().and_then(|id| self.items.get_mut(*id)) {
                    Some(Item::List(list)) => list.extend(values),
                    _ => return Err(self.wrong("values are appended to something other than a list")),
                }
            }
            b's' | b'u' => {
                let values = match code {
                    b's' => {
                        let value = self.pop()?;
                        vec![self.pop()?, value]
                    }
                    _ => self.marked()?,
                };
                match self.stack.last().and_then(|id| self.items.get_mut(*id)) {
                    Some(Item::Dictionary(entries)) => {
                        entries.extend(values.as_chunks::<2>().0.iter().map(|[key, value]| (*key, *value)));
                    }
                    _ => return Err(self.wrong("values are set in something other than a dictionary")),
                }
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn memory(&mut self, code: u8) -> Result<bool> {
        let key = match code {
            b'q' | b'h' => u64::from(u8::from_le_bytes(self.fixed()?)),
            b'r' | b'j' => u64::from(u32::from_le_bytes(self.fixed()?)),
            0x94 => self.memo.len() as u64,
            0x80 => return self.fixed::<1>().map(|_| true),
            0x95 => return self.fixed::<8>().map(|_| true),
            b'0' => return self.pop().map(|_| true),
            b'1' => return self.marked().map(|_| true),
            _ => return Ok(false),
        };
        if matches!(code, b'h' | b'j') {
            let id = self
                .memo
                .get(&key)
                .copied()
                .ok_or_else(|| self.wrong("a value is read from the memo that was never stored"))?;
            self.stack.push(id);
        } else {
            let id = self.stack.last().copied().ok_or_else(|| self.wrong("a value is missing"))?;
            self.memo.insert(key, id);
        }
        Ok(true)
    }

    fn object(&mut self, code: u8) -> Result<bool> {
        match code {
            b'c' => {
                let (module, name) = (self.line()?, self.line()?);
                self.push(Item::Global(module, name));
            }
            0x93 => {
                let (name, module) = (self.pop()?, self.pop()?);
                let (Item::Text(module), Item::Text(name)) = (self.item(module), self.item(name)) else {
                    return Err(self.wrong("a name is not a text"));
                };
                self.copy(module.as_bytes()).and_then(|_| self.copy(name.as_bytes()))?;
                let global = Item::Global(module.clone(), name.clone());
                self.push(global);
            }
            b'R' => {
                let (arguments, function) = (self.pop()?, self.pop()?);
                let value = self.reduce(function, arguments)?;
                self.push(value);
            }
            b'b' => {
                let state = self.pop()?;
                self.build(state)?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Evaluates the few functions that construct plain data.
    fn reduce(&self, function: Id, arguments: Id) -> Result<Item> {
        let (Item::Global(module, name), Item::List(arguments)) = (self.item(function), self.item(arguments))
        else {
            return Err(self.wrong("something other than a name is called"));
        };
        let argument = |at: usize| arguments.get(at).map_or(&Item::None, |id| self.item(*id));
        match (module.as_str(), name.as_str()) {
            ("numpy", "dtype") => match argument(0) {
                Item::Text(descr) => Ok(Item::Type(NpyType::from_descr(descr)?, descr.clone())),
                _ => Err(self.wrong("an element type has no name")),
            },
            ("numpy.core.multiarray" | "numpy._core.multiarray", "_reconstruct") => Ok(Item::Unfilled),
            ("numpy.core.multiarray" | "numpy._core.multiarray", "scalar") => {
                match (argument(0), argument(1)) {
                    (Item::Type(number, _), Item::Bytes(bytes)) => self.array(vec![1], *number, false, bytes),
                    _ => Err(self.wrong("a scalar has no type or no bytes")),
                }
            }
            ("numpy.core.numeric" | "numpy._core.numeric", "_frombuffer") => match (argument(0), argument(1))
            {
                (Item::Bytes(bytes), Item::Type(number, _)) => {
                    let fortran_order = matches!(argument(3), Item::Text(order) if order == "F");
                    self.array(self.shape(argument(2))?, *number, fortran_order, bytes)
                }
                _ => Err(self.wrong("an array has no values")),
            },
            ("_codecs", "encode") => match argument(0) {
                // Protocol 2 has no bytes: they are encoded as Latin-1 texts.
                Item::Text(text) => {
                    self.copy(text.as_bytes())?;
                    let bytes: Result<Vec<u8>, _> =
                        text.chars().map(|letter| u8::try_from(u32::from(letter))).collect();
                    bytes.map(Item::Bytes).map_err(|_| self.wrong("a text of bytes is not Latin-1"))
                }
                _ => Err(self.wrong("bytes are not encoded as a text")),
            },
            ("__builtin__" | "builtins", "bytes") => Ok(Item::Bytes(Vec::new())),
            _ => Err(code_error(&format!("{module}.{name}"))),
        }
    }

    fn shape(&self, item: &Item) -> Result<Vec<usize>> {
        let Item::List(sides) = item else { return Err(self.wrong("an array has no shape")) };
        let side = |id: &Id| match self.item(*id) {
            Item::Whole(side) => usize::try_from(*side).ok(),
            _ => None,
        };
        let sides: Option<Vec<_>> = sides.iter().take(MAX_AXES + 1).map(side).collect();
        sides.filter(|sides| sides.len() <= MAX_AXES).ok_or_else(|| self.wrong("an array has no shape"))
    }

    fn array(&self, shape: Vec<usize>, number: NpyType, fortran_order: bool, bytes: &[u8]) -> Result<Item> {
        let expected = shape.iter().try_fold(number.bytes(), |bytes, side| bytes.checked_mul(*side));
        if expected != Some(bytes.len()) {
            return Err(self.wrong(&format!("an array of shape {shape:?} has {} bytes", bytes.len())));
        }
        Ok(Item::Array(shape, number, fortran_order, self.copy(bytes)?.to_vec()))
    }

    /// Fills an array, or sets the byte order of a type.
    fn build(&mut self, state: Id) -> Result<()> {
        let target = self.stack.last().copied().ok_or_else(|| self.wrong("a value is missing"))?;
        let Item::List(state) = self.item(state) else { return Err(self.wrong("a state is not a tuple")) };
        let part = |at: usize| state.get(at).map_or(&Item::None, |id| self.item(*id));
        let built = match self.item(target) {
            Item::Type(_, descr) => match part(1) {
                Item::Text(order) => {
                    let descr = descr.clone();
                    Item::Type(NpyType::from_descr(&format!("{order}{descr}"))?, descr)
                }
                _ => return Err(self.wrong("an element type has no byte order")),
            },
            Item::Unfilled => match (part(2), part(3), part(4)) {
                (Item::Type(number, _), Item::Whole(order), Item::Bytes(bytes)) => {
                    self.array(self.shape(part(1))?, *number, *order != 0, bytes)?
                }
                _ => return Err(self.wrong("an array has no values")),
            },
            _ => return Err(code_error("the state of an object")),
        };
        if let Some(item) = self.items.get_mut(target) {
            *item = built;
        }
        Ok(())
    }
}

#[cold]
fn code_error(what: &str) -> Error {
    Error::unsupported(format!("the pickle refers to {what:.80?}, which is code; save its data as .npy"))
}
