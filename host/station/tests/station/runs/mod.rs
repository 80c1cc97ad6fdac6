//! Runs of the program, from the serial number to what is stored.

mod again;
mod alone;
pub(crate) mod bench;
pub(crate) mod checked;
mod ends;
mod faults;
mod foreign;
pub(crate) mod identity;
mod killed;
mod killed_lane;
mod limited;
pub(crate) mod outlived;
mod recovered;
mod retried;
mod saved;
mod unsaved;
