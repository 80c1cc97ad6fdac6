//! An FT2232H as a program: what FTDI's data sheet says that the chip does, to test drivers of it.
//!
//! ```text
//! driver ── URBs ──► vhci-hcd ── USB/IP over a socket pair ──► Chip ─┬─ channel A  (JTAG on the boards: nothing behind it)
//! (kernel's or ours)                                                 └─ channel B ── FarEnd: the board
//! ```
//!
//! [`Chip`] has descriptors, requests and channels; it reads no clock. [`Plugged`] is a chip in a port of the kernel's
//! `vhci-hcd`. Nothing here is shared with the programs that are tested with it.

mod channel;
mod chip;
mod descriptors;
mod eeprom;
mod far_end;
mod plugged;
mod server;
mod urb;

pub use chip::{Chip, ChipOptions};
pub use eeprom::{ChannelMode, Eeprom};
pub use far_end::{Endless, FarEnd, Loopback, Unplugged};
pub use plugged::Plugged;
