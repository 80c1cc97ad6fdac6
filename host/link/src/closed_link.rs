//! What remains of a link that was closed.

use std::time::Duration;

use super::{Link, LinkError};

/// A link that leads nowhere.
#[derive(Clone, Copy, Debug)]
pub struct ClosedLink;

impl Link for ClosedLink {
    fn exchange(&mut self, _: &[u8], _: &mut Vec<u8>, _: Duration) -> Result<usize, LinkError> {
        Err(LinkError::Closed { link: self.name(), at: Duration::ZERO })
    }

    fn now(&self) -> Duration {
        Duration::ZERO
    }

    fn bytes_per_second(&self) -> Option<f64> {
        None
    }

    fn name(&self) -> String {
        "the link".to_owned()
    }
}
