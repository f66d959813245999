//! `#[derive(Params)]`, `#[derive(Inputs)]` and `#[derive(Targets)]`: static tables and thin glue, no behaviour.
