//! Writes down what each code means, as the sources say it, and links the program at a fixed address, for where glibc loads it.
//!
//! A program that may lie anywhere has some 15,000 pointers put right by the loader before `main`, which copies every page
//! that they lie on: as long as all of `halfrow --help` takes else. Libraries, heap and stack still lie at random addresses.

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
