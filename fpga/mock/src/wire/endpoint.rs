//! What may stand at the far end of a wire.

use std::convert::Infallible;
use std::time::Duration;

use crate::board::Board;

/// A board that takes bytes and has bytes to send. It takes no time of the wire's clock: all that it can do it does when
/// bytes arrive.
pub trait Endpoint {
    /// Why a board can stop for good.
    type Failure: std::error::Error + Clone;

    /// Takes bytes that arrive together, at the time `now` since the board was switched on.
    ///
    /// # Errors
    /// If the board will not answer any more.
    fn receive(&mut self, bytes: &[u8], now: Duration) -> Result<(), Self::Failure>;

    /// Bytes that wait to be sent to the host.
    fn outgoing(&mut self) -> &mut Vec<u8>;
}

impl Endpoint for Board {
    type Failure = Infallible;

    fn receive(&mut self, bytes: &[u8], now: Duration) -> Result<(), Infallible> {
        Self::receive(self, bytes, now);
        Ok(())
    }

    fn outgoing(&mut self) -> &mut Vec<u8> {
        self.outgoing()
    }
}
