//! The cards and class lists that are built in.

use opendr_engine::Result;
use opendr_engine::target::Classes;

use crate::card::Card;

include!(concat!(env!("OUT_DIR"), "/embedded.rs"));

/// Every card in `models/`, in order of name.
///
/// # Errors
/// `Format` when a card is faulty, which the tests exclude.
pub fn embedded_cards() -> Result<Vec<Card>> {
    CARDS.iter().map(|(_, text)| Card::from_toml(text)).collect()
}

/// The class names in `models/classes/<list>.txt`, one a line.
pub(crate) fn classes(list: &str) -> Option<Classes> {
    let (_, text) = CLASS_LISTS.iter().find(|(name, _)| *name == list)?;
    Some(text.lines().map(str::trim).filter(|line| !line.is_empty()).collect())
}
