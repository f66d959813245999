#![no_main]

#[path = "../c_calls.rs"]
mod c_calls;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| c_calls::run(bytes));
