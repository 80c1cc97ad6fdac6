//! What may be at the far end of a pipe.

use std::time::Duration;

/// A board that takes bytes and has bytes to send. It takes no time on the pipe's clock: it does everything it can when
/// bytes arrive.
pub trait Endpoint {
    /// Why a board can stop for good.
    type Failure: std::error::Error + Clone;

    /// Takes bytes that arrive together, at the time `now` since the board was switched on.
    ///
    /// # Errors
    /// If the board will never answer again.
    fn receive(&mut self, bytes: &[u8], now: Duration) -> Result<(), Self::Failure>;

    /// Bytes that wait to be sent to the host.
    fn outgoing(&mut self) -> &mut Vec<u8>;
}
