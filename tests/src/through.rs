//! Links that wrap another one and change what is exchanged.

use std::time::Duration;

use halfrow::link::{Link, LinkError};

/// A link whose exchanges `exchange` makes by means of `link`; its clock, speed and name are that link's.
pub struct Through<F> {
    link: Box<dyn Link>,
    exchange: F,
}

impl<F> Through<F>
where
    F: FnMut(&mut dyn Link, &[u8], &mut Vec<u8>, Duration) -> Result<usize, LinkError> + Send + 'static,
{
    /// `link`, with its exchanges made by `exchange`.
    #[must_use]
    pub fn boxed(link: Box<dyn Link>, exchange: F) -> Box<dyn Link> {
        Box::new(Self { link, exchange })
    }
}

impl<F> Link for Through<F>
where
    F: FnMut(&mut dyn Link, &[u8], &mut Vec<u8>, Duration) -> Result<usize, LinkError> + Send,
{
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        (self.exchange)(&mut *self.link, outgoing, incoming, wait)
    }

    fn now(&self) -> Duration {
        self.link.now()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        self.link.bytes_per_second()
    }

    fn name(&self) -> String {
        self.link.name()
    }
}
