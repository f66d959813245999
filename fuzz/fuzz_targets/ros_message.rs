#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| opendr_messages::fuzzing::ros_message(bytes));
