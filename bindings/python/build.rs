//! Keeps the wheel small: functions that came out alike are one. Rust's generic code has many; the linker that Rust brings
//! along on this system knows how.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let is = |key: &str, value: &str| std::env::var(key).is_ok_and(|found| found == value);
    if is("CARGO_CFG_TARGET_OS", "linux") && is("CARGO_CFG_TARGET_ARCH", "x86_64") && is("PROFILE", "release")
    {
        println!("cargo:rustc-cdylib-link-arg=-Wl,--icf=all");
    }
}
