//! Planning of motion.

pub mod end_to_end;
