//! What all lists of things found have in common.

use opendr::{Datum, Error, Result, Value};

use crate::handle::Out;
use crate::pointer::{place, slice};
use crate::texts::Texts;
use crate::value::AnyValue;

/// Most items of a list: more than any picture holds.
const MAX_ITEMS: usize = 1 << 24;

/// A list of targets and how C sees its items.
pub(super) trait List: Datum + Into<Value> + From<Vec<Self::Item>> {
    /// What the list holds.
    type Item;
    /// What C calls an item.
    type Plain;

    fn items(&self) -> &[Self::Item];

    /// An item for C; texts and memory that it points to live as long as the list.
    fn plain(&self, item: &Self::Item, texts: &Texts) -> Self::Plain;

    /// An item from C.
    ///
    /// # Safety
    /// What it points to is there.
    unsafe fn item(plain: &Self::Plain) -> Result<Self::Item>;
}

/// Makes a list of items.
///
/// # Safety
/// `items` leads to `count` items, and all that they point to is there; `list` may be written to.
pub(super) unsafe fn create<L: List, P>(
    items: *const L::Plain,
    count: usize,
    list: *mut *mut P,
) -> Result<()> {
    // SAFETY: the caller's promise.
    let out = unsafe { Out::new(list, "list") }?;
    if count > MAX_ITEMS {
        return Err(Error::invalid_input(format!(
            "a list of {count} items is too long; give at most {MAX_ITEMS}"
        )));
    }
    // SAFETY: the caller's promise.
    let items = unsafe { slice(items, count, "items") }?;
    // SAFETY: the caller's promise.
    let items = items.iter().map(|plain| unsafe { L::item(plain) }).collect::<Result<Vec<_>>>()?;
    out.set(AnyValue::from(L::from(items)));
    Ok(())
}

/// How many items a list has.
///
/// # Safety
/// As [`crate::handle::held`].
pub(super) unsafe fn count<L: List, P>(list: *const P) -> Result<usize> {
    // SAFETY: the caller's promise.
    Ok(unsafe { AnyValue::of(list, "list") }?.typed::<L>("list")?.items().len())
}

/// Shows an item of a list.
///
/// # Safety
/// As [`crate::handle::held`]; `item` is null or may be written to.
pub(super) unsafe fn get<L: List, P>(list: *const P, index: usize, item: *mut L::Plain) -> Result<()> {
    let place = place(item, "item")?;
    // SAFETY: the caller's promise.
    let value = unsafe { AnyValue::of(list, "list") }?;
    let list = value.typed::<L>("list")?;
    let item = list.items().get(index).ok_or_else(|| {
        let count = list.items().len();
        Error::invalid_input(format!("there is no item {index}; there are {count}, counted from 0"))
    })?;
    // SAFETY: the caller's promise.
    unsafe { place.write(list.plain(item, &value.texts)) };
    Ok(())
}
