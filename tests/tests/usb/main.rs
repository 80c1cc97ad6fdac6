//! The link over USB, on Debian's kernel and emulated chips. `scripts/in-linux` boots that kernel, and says how.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used)]

mod chosen;
mod in_use;
mod judged;
mod kernels_driver;
mod long;
mod qemu;
mod refused;
mod scenarios;
mod unplugged;
