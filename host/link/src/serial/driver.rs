//! What the driver behind a port counts, and how soon it passes bytes on.
//!
//! In this crate `unsafe` is allowed only here: no crate at hand has these two requests of Linux (include/uapi/linux/serial.h). Why it
//! is sound: each is made with the structure that this header demands of it, field by field, which consists of numbers alone, and
//! lives through the call; the kernel keeps no pointer to it. A driver without such a request refuses it and touches nothing, as that
//! of pseudo-terminals does.

#![allow(unsafe_code)]

use std::os::fd::AsRawFd;

use nix::libc::{TIOCGICOUNT, TIOCGSERIAL, TIOCSSERIAL, c_char, c_int, c_uint, c_ulong, c_ushort};
use nix::{ioctl_read_bad, ioctl_write_ptr_bad};

use crate::LineErrors;

/// `ASYNC_LOW_LATENCY` of include/uapi/linux/tty_flags.h.
const LOW_LATENCY: c_int = 1 << 13;

/// `serial_icounter_struct`: what the driver has counted since it made the port. Its numbers wrap around.
#[repr(C)]
#[derive(Debug, Default)]
pub(super) struct Counts {
    modem_lines: [c_uint; 4],
    received: c_uint,
    sent: c_uint,
    framing: c_uint,
    overrun: c_uint,
    parity: c_uint,
    breaks: c_uint,
    buffer_overrun: c_uint,
    reserved: [c_uint; 9],
}

/// `serial_struct`: settings of a port, most of which are those of chips on a mainboard.
#[repr(C)]
#[derive(Debug, Default)]
struct Settings {
    kind: c_int,
    line: c_int,
    port: c_uint,
    interrupt: c_int,
    flags: c_int,
    fifo: c_int,
    divisor: c_int,
    baud_base: c_int,
    close_delay: c_ushort,
    io_type: c_char,
    reserved: c_char,
    hub6: c_int,
    closing_wait: [c_ushort; 2],
    memory: usize,
    memory_shift: c_ushort,
    port_high: c_uint,
    memory_base: c_ulong,
}

ioctl_read_bad!(get_counts, TIOCGICOUNT, Counts);
ioctl_read_bad!(get_settings, TIOCGSERIAL, Settings);
ioctl_write_ptr_bad!(set_settings, TIOCSSERIAL, Settings);

impl Counts {
    /// Those of `port`; none if its driver does not count, or the port is gone.
    pub(super) fn of(port: &impl AsRawFd) -> Option<Self> {
        let mut counts = Self::default();
        // SAFETY: see the head of this file.
        unsafe { get_counts(port.as_raw_fd(), &raw mut counts) }.ok()?;
        Some(counts)
    }

    /// The errors that were counted after `earlier`.
    pub(super) fn since(&self, earlier: &Self) -> LineErrors {
        let more = |now: c_uint, then: c_uint| u64::from(now.wrapping_sub(then));
        LineErrors {
            overrun: more(self.overrun, earlier.overrun) + more(self.buffer_overrun, earlier.buffer_overrun),
            parity: more(self.parity, earlier.parity),
            framing: more(self.framing, earlier.framing),
            breaks: more(self.breaks, earlier.breaks),
        }
    }
}

/// Has the chip behind `port` hold back what it has received for as short a time as its driver knows: 1 ms of FTDI's chips instead of
/// 16 ms (drivers/usb/serial/ftdi_sio.c, `write_latency_timer`).
///
/// # Errors
/// When the driver knows no such setting, or leaves it to root.
pub(super) fn hold_nothing_back(port: &impl AsRawFd) -> nix::Result<()> {
    let mut settings = Settings::default();
    // SAFETY: see the head of this file.
    unsafe { get_settings(port.as_raw_fd(), &raw mut settings) }?;
    settings.flags |= LOW_LATENCY;
    // SAFETY: see the head of this file.
    unsafe { set_settings(port.as_raw_fd(), &raw const settings) }?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use serialport::TTYPort;

    use super::*;

    /// The sizes that gcc 12 gives for linux/serial.h.
    #[test]
    #[cfg(target_pointer_width = "64")]
    fn the_structures_are_as_long_as_the_kernel_s() {
        assert_eq!((size_of::<Counts>(), size_of::<Settings>()), (80, 72));
    }

    #[test]
    fn errors_are_those_since_and_their_counts_wrap_around() {
        let earlier = Counts { overrun: u32::MAX, framing: 7, breaks: 1, ..Counts::default() };
        let now =
            Counts { overrun: 1, buffer_overrun: 3, framing: 9, breaks: 1, parity: 4, ..Counts::default() };
        let expected = LineErrors { overrun: 5, parity: 4, framing: 2, breaks: 0 };
        assert_eq!(now.since(&earlier), expected);
    }

    #[test]
    fn a_pseudo_terminal_counts_nothing_and_has_no_such_setting() {
        let (_board, port) = TTYPort::pair().unwrap();
        assert!(Counts::of(&port).is_none());
        assert!(hold_nothing_back(&port).is_err());
    }
}
