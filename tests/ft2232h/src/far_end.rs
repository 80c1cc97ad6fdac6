//! What is connected to a channel's pins.

use std::collections::VecDeque;
use std::time::Duration;

/// The chip has lost its host or its power.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unplugged;

/// A device at a channel.
pub trait FarEnd: Send {
    /// Takes what it can of `to_board`, appends to `to_host` what it has to send at the time `now` since it was plugged in, and
    /// returns how many bytes it took. It is called at least every millisecond while a host listens.
    ///
    /// # Errors
    /// [`Unplugged`] when the whole chip shall vanish at this point.
    fn exchange(&mut self, to_board: &[u8], to_host: &mut Vec<u8>, now: Duration)
    -> Result<usize, Unplugged>;
}

/// Sends back what it receives.
#[derive(Debug, Default)]
pub struct Loopback(VecDeque<u8>);

impl FarEnd for Loopback {
    fn exchange(&mut self, to_board: &[u8], to_host: &mut Vec<u8>, _: Duration) -> Result<usize, Unplugged> {
        self.0.extend(to_board);
        to_host.extend(self.0.drain(..));
        Ok(to_board.len())
    }
}

/// Takes everything and always has something to send.
#[derive(Debug, Default)]
pub struct Endless;

impl FarEnd for Endless {
    fn exchange(&mut self, to_board: &[u8], to_host: &mut Vec<u8>, _: Duration) -> Result<usize, Unplugged> {
        to_host.extend([0x5a; 4096]);
        Ok(to_board.len())
    }
}
