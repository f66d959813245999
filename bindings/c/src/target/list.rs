//! Functions for all lists of targets.

use opendr::{Datum, Error, Result, Value};

use crate::handle::Out;
use crate::pointer::{place, slice};
use crate::texts::Texts;
use crate::value::AnyValue;

/// Maximum number of items of a list.
const MAX_ITEMS: usize = 1 << 24;

/// A list of targets and its items in the form of C.
pub(super) trait List: Datum + Into<Value> + From<Vec<Self::Item>> {
    /// Type of the items.
    type Item;
    /// Type of the items in C.
    type Plain;

    fn items(&self) -> &[Self::Item];

    /// Converts an item for C; its texts and pointers are valid as long as the list.
    fn plain(&self, item: &Self::Item, texts: &Texts) -> Self::Plain;

    /// Converts an item from C.
    ///
    /// # Safety
    /// Its pointers are valid.
    unsafe fn item(plain: &Self::Plain) -> Result<Self::Item>;
}

/// Creates a list of items.
///
/// # Safety
/// `items` points to `count` items, whose pointers are valid; `list` may be written to.
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

/// Returns the number of items of a list.
///
/// # Safety
/// The same as for [`crate::handle::held`].
pub(super) unsafe fn count<L: List, P>(list: *const P) -> Result<usize> {
    // SAFETY: the caller's promise.
    Ok(unsafe { AnyValue::of(list, "list") }?.typed::<L>("list")?.items().len())
}

/// Writes an item of a list into `item`.
///
/// # Safety
/// The same as for [`crate::handle::held`]; `item` is null or may be written to.
pub(super) unsafe fn get<L: List, P>(list: *const P, index: usize, item: *mut L::Plain) -> Result<()> {
    let place = place(item, "item")?;
    // SAFETY: the caller's promise.
    let value = unsafe { AnyValue::of(list, "list") }?;
    let list = value.typed::<L>("list")?;
    let item = list.items().get(index).ok_or_else(|| {
        let count = list.items().len();
        Error::invalid_input(format!("item {index} is out of range; the list has {count} items"))
    })?;
    // SAFETY: the caller's promise.
    unsafe { place.write(list.plain(item, &value.texts)) };
    Ok(())
}
