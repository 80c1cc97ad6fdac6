//! A board whose replies do not have bit 0 of the flags is heard all the same: WIRE.md says that nobody looks at it.

use std::time::Duration;

use halfrow_protocol::{Decoder, Encoder, Header};

use super::{Board, OpenOptions};
use crate::link::{Link, LinkError, open};

/// A link that clears the flag in all that the board says.
struct Unflagged {
    link: Box<dyn Link>,
    decoder: Decoder,
    cleared: usize,
}

impl Link for Unflagged {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        let mut said = Vec::new();
        let taken = self.link.exchange(outgoing, &mut said, wait)?;
        let mut said = said.as_slice();
        while let Some(packet) = self.decoder.next(&mut said) {
            let packet = packet.unwrap();
            self.cleared += usize::from(packet.header.reply);
            let header = Header { reply: false, ..packet.header };
            Encoder::new().encode(&header, |to| to.extend_from_slice(packet.payload), incoming).unwrap();
        }
        assert!(self.cleared > 0 || incoming.is_empty());
        Ok(taken)
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

#[test]
fn a_board_whose_replies_are_not_flagged_is_heard() {
    let link = open(&"mock".parse().unwrap()).unwrap().link;
    let link = Box::new(Unflagged { link, decoder: Decoder::new(), cleared: 0 });
    let mut board = Board::open(link, &OpenOptions::default()).map_err(|(error, _)| error).unwrap();
    assert!(board.echo(b"heard").unwrap().0);
}
