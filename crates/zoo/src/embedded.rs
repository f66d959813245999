//! Built-in cards and class lists.

use opendr_engine::Result;
use opendr_engine::target::Classes;

use crate::card::Card;

include!(concat!(env!("OUT_DIR"), "/embedded.rs"));

/// Returns all cards of `models/`, in order of name.
///
/// # Errors
/// `Format` for an invalid card, which the tests exclude.
pub fn embedded_cards() -> Result<Vec<Card>> {
    CARDS.iter().map(|(_, text)| Card::from_toml(text)).collect()
}

/// Returns the class names of `models/classes/<list>.txt`, one per line.
pub(crate) fn classes(list: &str) -> Option<Classes> {
    let (_, text) = CLASS_LISTS.iter().find(|(name, _)| *name == list)?;
    Some(text.lines().map(str::trim).filter(|line| !line.is_empty()).collect())
}
