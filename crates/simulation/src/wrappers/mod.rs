//! Environments around environments.

mod checked;
#[cfg(test)]
mod tests;
mod time_limit;

pub use checked::Checked;
pub use time_limit::TimeLimit;
