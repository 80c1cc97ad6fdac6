//! Runs of the program, from the serial number to what is kept.

pub(crate) mod bench;
mod checked;
mod ends;
mod faults;
mod identity;
mod killed;
mod saved;
mod unsaved;
