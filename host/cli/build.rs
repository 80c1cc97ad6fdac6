//! Writes a table of what each code means, from the comments in the sources; and links the program at a fixed address if glibc
//! loads it.
//!
//! In a position-independent program the loader relocates some 15,000 pointers before `main`, which copies every page that they
//! are on. That takes as long as everything else in `halfrow --help`. Libraries, heap and stack are still at random addresses.

#[path = "build/meanings.rs"]
mod meanings;
#[path = "build/sources.rs"]
mod sources;

use std::{env, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=build");
    let target = |key: &str| env::var(format!("CARGO_CFG_TARGET_{key}")).unwrap_or_default();
    let is_loaded = !target("FEATURE").split(',').any(|feature| feature == "crt-static");
    if target("OS") == "linux" && target("ENV") == "gnu" && is_loaded {
        println!("cargo::rustc-link-arg-bins=-no-pie");
    }
    meanings::write()
}
